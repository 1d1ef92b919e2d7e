"""The front from mesh to named object: what all choices together gain, and what they cost."""
