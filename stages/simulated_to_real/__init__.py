"""How far simulated imprints help to recognise real touches."""
