"""A small stand-in for `rclpy` and the messages that an example uses, where ROS 2 is not installed.

It has what the example touches, by the names and types of ROS 2's: no middleware, no threads.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import ModuleType, SimpleNamespace
from typing import Any, ClassVar


@dataclass
class Stamp:
    sec: int = 0
    nanosec: int = 0


@dataclass
class Header:
    stamp: Stamp = field(default_factory=Stamp)
    frame_id: str = ""


@dataclass
class CameraInfo:
    header: Header = field(default_factory=Header)
    height: int = 0
    width: int = 0
    k: list[float] = field(default_factory=lambda: [0.0] * 9)


@dataclass
class Image:
    header: Header = field(default_factory=Header)
    height: int = 0
    width: int = 0
    encoding: str = ""
    is_bigendian: int = 0
    step: int = 0
    data: bytes = b""


@dataclass
class Vector3:
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass
class Imu:
    header: Header = field(default_factory=Header)
    angular_velocity: Vector3 = field(default_factory=Vector3)
    linear_acceleration: Vector3 = field(default_factory=Vector3)


@dataclass
class JointState:
    header: Header = field(default_factory=Header)
    name: list[str] = field(default_factory=list)
    position: list[float] = field(default_factory=list)
    velocity: list[float] = field(default_factory=list)
    effort: list[float] = field(default_factory=list)


@dataclass
class Float64MultiArray:
    data: list[float] = field(default_factory=list)


@dataclass
class String:
    data: str = ""


SENSOR_DATA = object()
"""A quality of service that hears publishers of either kind: the others do not."""


class Publisher:
    def __init__(self) -> None:
        self.sent: list[Any] = []

    def publish(self, message: object) -> None:
        self.sent.append(message)


class Node:
    """Parameters as they are set here, topics by their names."""

    parameters: ClassVar[dict[str, Any]] = {}

    def __init__(self, name: str) -> None:
        self.name = name
        self.heard: dict[str, tuple[type, Callable[[Any], None]]] = {}
        self.published: dict[str, Publisher] = {}

    def declare_parameter(self, name: str, default: object) -> SimpleNamespace:
        return SimpleNamespace(value=self.parameters.get(name, default))

    def create_subscription(
        self, kind: type, topic: str, callback: Callable[[Any], None], quality: object
    ) -> None:
        assert quality is SENSOR_DATA
        self.heard[topic] = (kind, callback)

    def create_publisher(self, kind: type, topic: str, depth: int) -> Publisher:
        assert kind in (JointState, String)
        assert depth > 0
        return self.published.setdefault(topic, Publisher())

    def hear(self, topic: str, message: object) -> None:
        """What a publisher of another node would cause."""
        kind, callback = self.heard[topic]
        assert isinstance(message, kind)
        callback(message)


MODULES: dict[str, tuple[type, ...]] = {
    "rclpy": (),
    "rclpy.node": (Node,),
    "rclpy.qos": (),
    "sensor_msgs": (),
    "sensor_msgs.msg": (CameraInfo, Image, Imu, JointState),
    "std_msgs": (),
    "std_msgs.msg": (Float64MultiArray, String),
}


@contextmanager
def stand_in(parameters: dict[str, Any]) -> Iterator[None]:
    """Let these modules be imported; nodes find these parameters."""
    before = {name: sys.modules.get(name) for name in MODULES}
    for name, kinds in MODULES.items():
        made = ModuleType(name)
        for kind in kinds:
            setattr(made, kind.__name__, kind)
        sys.modules[name] = made
    sys.modules["rclpy.qos"].__dict__["qos_profile_sensor_data"] = SENSOR_DATA
    Node.parameters = parameters
    try:
        yield
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module
