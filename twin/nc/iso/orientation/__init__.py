"""The tool's orientation: targets of rotary axes, tilted planes, tool centre point control."""
