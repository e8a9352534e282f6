"""A scenario's elements as MuJoCo geometry, and what happens on the way."""
