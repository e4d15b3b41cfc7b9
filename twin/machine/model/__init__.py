"""The machine in MuJoCo: bodies, drives, transmissions, the shapes of tool and head."""
