"""Touches objects until the belief is strong (T4.2.3.5)."""
