"""Random numbers: one seeded generator per component, so that no component disturbs another's."""

from zlib import crc32

import numpy as np


def stream(seed: int, name: str) -> np.random.Generator:
    """Return the generator of one component.

    The same seed and name always give the same numbers, whatever else was drawn before, and
    different names give independent ones.

    Args:
        seed: the episode's seed, not negative.
        name: the component's name, such as ``"sensors.imu"``.
    """
    return np.random.default_rng(np.random.SeedSequence([seed, crc32(name.encode())]))


class RandomStreams:
    """The streams of one episode: ``streams("sensors.imu")`` is a fresh generator of that name."""

    def __init__(self, seed: int) -> None:
        """Remember the episode's seed.

        Args:
            seed: not negative.
        """
        self.seed = seed

    def __call__(self, name: str) -> np.random.Generator:
        """Return the generator of the component `name`, at its beginning."""
        return stream(self.seed, name)
