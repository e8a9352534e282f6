"""The depth camera in time: when it exposes, when its frames arrive, when it is blind."""

from collections import deque
from dataclasses import replace

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
        brightness: NDArray[np.uint8] | None = None,
    ) -> None:
        """Join the parts.

        Args:
            camera: where the rays start.
            errors: the sensor's; None: the exact depth is delivered.
            period_ns: from one exposure to the next.
            latency_ns: from exposure to arrival.
            brightness: (ngeom,) of each geom; None: frames have no intensity.
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
        self._brightness = brightness
        self._under_way: deque[Frame] = deque()

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
                self._under_way.append(self._expose(data, time_ns))
        if not self._under_way:
            return None
        arrived = None
        while self._under_way and self._under_way[0].exposure_ns + self._latency_ns <= time_ns:
            arrived = replace(self._under_way.popleft(), arrival_ns=time_ns)
        return arrived

    def _expose(self, data: mujoco.MjData, time_ns: int) -> Frame:
        """Return the images of the present state, not yet arrived."""
        if self._errors is None:
            depth = self.camera.cast(data).depth.astype(np.float32)
        else:
            depth = self.camera.see(data, self._errors)
        if self._brightness is None:
            return Frame(time_ns, time_ns, depth)
        geom = self.camera.cast(data).geom
        intensity = np.where(geom < 0, 0, self._brightness[geom]).astype(np.uint8)
        return Frame(time_ns, time_ns, depth, intensity)


def brightness(model: mujoco.MjModel) -> NDArray[np.uint8]:
    """Return how bright each geom is by its colour, (ngeom,); light and shadow play no part."""
    colour = model.geom_rgba[:, :3].copy()
    painted = model.geom_matid >= 0
    colour[painted] = model.mat_rgba[model.geom_matid[painted], :3]
    shade: NDArray[np.uint8] = np.rint(255.0 * np.clip(colour.mean(axis=1), 0, 1)).astype(np.uint8)
    return shade
