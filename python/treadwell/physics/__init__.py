"""The physics: MuJoCo stepped by the servos alone, with an audit of every step."""
