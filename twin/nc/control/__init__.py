"""The control: modal state, program flow, variables, what a block does."""
