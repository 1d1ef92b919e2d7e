"""One page about a person's own meshes: where people look, fewer faces, and what a pressure array feels there."""
