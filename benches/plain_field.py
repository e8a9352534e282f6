"""A plain likelihood field in sixty lines: what the localizer `monte_carlo` must be as good as."""

import numpy as np
from made_rooms import CENTRE, FOCAL, Floats, small_turn
from numpy.typing import NDArray

_REACH = 5
"""Voxels: what is further from a surface than this is as bad as can be."""


def distances(solid: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Return how far, in voxels, the nearest solid voxel is, at most `_REACH`."""
    found = np.full(solid.shape, float(_REACH), dtype=np.float32)
    span = np.arange(-_REACH, _REACH + 1)
    for off in np.stack(np.meshgrid(span, span, span), axis=-1).reshape(-1, 3):
        away = float(np.linalg.norm(off))
        if away < _REACH:
            shifted = np.roll(solid, off, axis=(0, 1, 2))
            np.minimum(found, np.where(shifted, np.float32(away), np.float32(_REACH)), out=found)
    return found


class PlainField:
    """Particles, weighed by how far a picture's points are from the next occupied voxel."""

    def __init__(
        self, centres: Floats, side: float, start: Floats, seed: int, particles: int = 500
    ) -> None:
        """Begin at a pose that is told, in a map of voxels by their centres."""
        voxels = np.floor(centres / side).astype(int)
        self._low, self._side = voxels.min(axis=0) - _REACH - 1, side
        solid = np.zeros(voxels.max(axis=0) - self._low + _REACH + 2, dtype=bool)
        solid[tuple((voxels - self._low).T)] = True
        self._field = distances(solid) * side
        self._draws = np.random.default_rng([seed, 4])
        self._poses = np.repeat(start[None], particles, axis=0)
        self._poses[:, :3, 3] += 0.02 * self._draws.normal(size=(particles, 3))
        self._weights = np.full(particles, 1.0 / particles)

    def update(self, depth: NDArray[np.float32], step: Floats) -> Floats:
        """Move by odometry, weigh by a hundred points, and return the mean pose (4, 4)."""
        draws, count = self._draws, len(self._poses)
        self._poses = self._poses @ step
        self._poses[:, :3, 3] += 0.008 * draws.normal(size=(count, 3))
        turns = 0.006 * draws.normal(size=(count, 3))
        turned = np.stack([small_turn(turn) for turn in turns])
        self._poses[:, :3, :3] = self._poses[:, :3, :3] @ turned
        seen = np.argwhere(np.isfinite(depth) & (depth < 4.0))
        rows, cols = seen[draws.choice(len(seen), min(100, len(seen)), replace=False)].T
        z = depth[rows, cols].astype(float)
        rays = np.stack([(cols - CENTRE[0]) / FOCAL, (rows - CENTRE[1]) / FOCAL, np.ones(len(z))])
        ends = self._poses[:, :3, :3] @ (rays * z) + self._poses[:, :3, 3:]
        at = np.floor(ends / self._side).astype(int) - self._low[:, None]
        inside = np.clip(at, 0, np.array(self._field.shape)[:, None] - 1)
        away = self._field[inside[:, 0], inside[:, 1], inside[:, 2]]
        likely = 0.9 * np.exp(-0.5 * (away / 0.03) ** 2) + 0.1
        logs = np.log(self._weights) + 0.1 * np.log(likely).sum(axis=1)
        self._weights = np.exp(logs - logs.max())
        self._weights /= self._weights.sum()
        mean = np.eye(4)
        mean[:3, 3] = self._weights @ self._poses[:, :3, 3]
        u, _, v = np.linalg.svd(np.einsum("n,nij->ij", self._weights, self._poses[:, :3, :3]))
        mean[:3, :3] = u @ v
        if 1.0 / (self._weights**2).sum() < 0.5 * count:
            steps = (np.arange(count) + draws.uniform()) / count
            chosen = np.minimum(np.searchsorted(np.cumsum(self._weights), steps), count - 1)
            self._poses, self._weights = self._poses[chosen], np.full(count, 1.0 / count)
        return mean
