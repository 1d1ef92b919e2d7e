"""How many pictures and channels the model of where people look needs."""
