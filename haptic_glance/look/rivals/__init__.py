"""Published detectors of salient points, one a file."""
