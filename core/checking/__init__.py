"""A take looked at before it is fitted: facts, faults, what a fit will cost."""
