"""The machine in the plant's language: OPC UA, by the companion specification for machine tools."""
