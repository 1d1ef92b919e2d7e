"""Disturbances by name and severity, one registry for each kind of input.

- `objects.PERTURBATIONS`: a mesh, and the light and the camera of its views;
- `touch_disturbances.TOUCH_PERTURBATIONS`: the place, the sensor and the model of a touch;
- `imprint.PERTURBATIONS`: an imprint;
- `picture.PICTURES`: a picture.
"""
