"""The experiment `footsteps`: courses on which every foot has to be planned."""
