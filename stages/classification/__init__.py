"""Recognises the objects of a data set by touch (T4.2)."""
