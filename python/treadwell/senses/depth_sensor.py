"""The depth camera in time: when it exposes, when its frames arrive, when it is blind."""

from collections import deque

import mujoco
import numpy as np
from numpy.typing import NDArray

from treadwell import _core
from treadwell.observation import Frame
from treadwell.senses.depth import DepthCamera


class DepthSensor:
    """Exposes at every multiple of its period; a frame arrives a fixed time after its exposure.

    Attributes:
        camera: where the rays start.
    """

    def __init__(
        self,
        camera: DepthCamera,
        errors: _core.DepthErrors | None,
        period_ns: int,
        latency_ns: int,
    ) -> None:
        """Join the parts.

        Args:
            camera: where the rays start.
            errors: the sensor's; None: the exact depth is delivered.
            period_ns: from one exposure to the next.
            latency_ns: from exposure to arrival.
        """
        if period_ns <= 0:
            raise ValueError(f"camera.period must be > 0, got {period_ns} ns")
        if latency_ns < 0:
            raise ValueError(f"sensors.latency must be >= 0, got {latency_ns} ns")
        self.camera = camera
        self._errors = errors
        self._period_ns = period_ns
        self._latency_ns = latency_ns
        self._next_ns = 0
        self._blind_until_ns = 0
        self._under_way: deque[tuple[int, NDArray[np.float32]]] = deque()

    def blind(self, until_ns: int) -> None:
        """Expose nothing before this time; what is under way still arrives."""
        self._blind_until_ns = max(self._blind_until_ns, until_ns)

    def observe(self, data: mujoco.MjData, time_ns: int) -> Frame | None:
        """Expose when it is time, and return the newest frame that has arrived since the last call.

        Args:
            data: the state, with all poses up to date; nothing in it is changed.
            time_ns: now, in steps no longer than the period.
        """
        if time_ns >= self._next_ns:
            self._next_ns = (time_ns // self._period_ns + 1) * self._period_ns
            if time_ns >= self._blind_until_ns:
                self._under_way.append((time_ns, self._expose(data)))
        if not self._under_way:
            return None
        arrived = None
        while self._under_way and self._under_way[0][0] + self._latency_ns <= time_ns:
            exposure_ns, depth = self._under_way.popleft()
            arrived = Frame(exposure_ns, time_ns, depth)
        return arrived

    def _expose(self, data: mujoco.MjData) -> NDArray[np.float32]:
        """Return the depth image (h, w) of the present state."""
        if self._errors is None:
            return self.camera.cast(data).depth.astype(np.float32)
        return self.camera.see(data, self._errors)
