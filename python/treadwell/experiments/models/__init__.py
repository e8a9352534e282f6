"""Every model of the ground on one suite and on recorded data: the experiment `models`."""
