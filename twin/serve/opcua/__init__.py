"""The machine in OPC UA, by the companion specification for machine tools."""
