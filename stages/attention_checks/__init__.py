"""Checks of attention on meshes with human gaze: the thesis's best viewpoints, and choices made without the object."""
