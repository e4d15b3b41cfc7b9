"""A machine as a unit for co-simulation (FMI 3): setpoints in, joints and loads out."""
