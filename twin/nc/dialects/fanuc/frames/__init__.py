"""Where a block of a Fanuc control lies: offsets, transformations, planes, reference points."""
