"""What a robot's walker can do with it, tried in MuJoCo without camera and map."""
