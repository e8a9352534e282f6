"""The core again over what a run recorded, without MuJoCo; and where two runs part."""
