"""Pictures and films of a run without a display: MuJoCo's rays in place of a graphics card."""
