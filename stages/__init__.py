"""Haptic Glance: look at a 3D object, touch only the places that matter, and know what it is.

One package per pipeline stage, in the order of the data; `kit` holds what several stages share.
"""
