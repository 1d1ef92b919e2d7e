"""Networks for photographs on recorded touches (T5.4)."""
