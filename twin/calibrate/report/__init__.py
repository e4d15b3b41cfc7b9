"""The page of a calibration: what was logged over what is predicted, and the answer in a sentence."""
