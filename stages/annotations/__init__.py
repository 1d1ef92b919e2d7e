"""How well marks of salient places agree with each other and with human gaze."""
