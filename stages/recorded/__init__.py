"""Touches that others recorded: T4.2.4's protocol on a real pressure array, slip and recognition by fingertips."""
