"""Salient point detectors of other authors, one file each, to compare with: saliency(mesh) and points(mesh)."""
