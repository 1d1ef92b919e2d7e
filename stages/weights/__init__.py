"""Learns channel weights of a data set, and reads its ground truth."""
