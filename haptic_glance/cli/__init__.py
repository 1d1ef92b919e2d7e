"""The commands of `haptic-glance`, one a file: arguments and printing."""
