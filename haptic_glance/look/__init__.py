"""Looking: views, conspicuity channels, the glance, the models of the thesis, rivals, agreement with gaze."""
