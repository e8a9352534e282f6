"""The core for a robot elsewhere: observations come over a socket, joint targets go back."""
