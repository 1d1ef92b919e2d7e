"""How many faces? The count that an object needs for an error that is tolerated at a distance (T3.1.3).

Three models, which need ever more measurements of the object: `models.fit_counts` learns from other objects (the
thesis's networks, or a linear model), `cases.power_law` extrapolates from one simplified mesh of the object, and
`models.Curve` looks up the object's own measured errors. `evaluate.evaluate_counts` compares them on objects that were
left out of the training.
"""
