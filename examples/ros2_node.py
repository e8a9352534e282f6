"""A node of ROS 2 between a robot's topics and `treadwell serve`.

    treadwell serve --robot qrio --socket core.sock &
    python3 ros2_node.py --ros-args -p server:=core.sock -p goal:="[2.0, 0.0]"

It runs in the interpreter of ROS 2, Python 3.8 or later with any numpy, and imports no treadwell:
that may live in an environment of its own, or on another machine. `server` is a socket file, or
PORT or HOST:PORT of a server behind `--tcp` (of another machine by `ssh -L`).

Joint states are control ticks: those that come sooner than a tick after the last are left out.
What came before of the other topics goes with them. Stamps are of one clock.
"""

import json
import math
import socket
import struct

import numpy as np
import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image, Imu, JointState
from std_msgs.msg import Float64MultiArray, String


class Core:
    """A connection to the server, as docs/how_to/serve.md tells the protocol."""

    def __init__(self, server: str, timeout_s: float, goal: list) -> None:
        """Connect and say hello; `robot` is what the server says of the robot."""
        host, _, port = server.rpartition(":")
        if port.isdigit():
            self.socket = socket.create_connection((host or "127.0.0.1", int(port)), timeout_s)
        else:
            self.socket = socket.socket(socket.AF_UNIX)
            self.socket.settimeout(timeout_s)
            self.socket.connect(server)
        self.stream = self.socket.makefile("rb")
        try:
            self.robot = self.ask({"type": "hello", "protocol": 1, "goal": {"position": goal}})
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """End the connection."""
        self.stream.close()
        self.socket.close()

    def ask(self, header: dict, **arrays: np.ndarray) -> dict:
        """Send a message, and return its answer, arrays and all."""
        listed = [{"name": n, "dtype": a.dtype.name, "shape": a.shape} for n, a in arrays.items()]
        text = json.dumps({**header, "arrays": listed}).encode()
        numbers = [a.astype(a.dtype.newbyteorder("<")).tobytes() for a in arrays.values()]
        self.socket.sendall(struct.pack("<Q", len(text)) + text + b"".join(numbers))
        answer = json.loads(self.read(*struct.unpack("<Q", self.read(8))))
        if answer["type"] == "error":
            raise RuntimeError("the server: " + answer["message"])
        for each in answer.pop("arrays"):
            kind = np.dtype(each["dtype"]).newbyteorder("<")
            data = self.read(kind.itemsize * math.prod(each["shape"]))
            answer[each["name"]] = np.frombuffer(data, kind).reshape(each["shape"])
        return answer

    def read(self, size: int) -> bytes:
        """Return so many bytes of the answer."""
        data = self.stream.read(size)
        if len(data) < size:
            raise RuntimeError("the server has gone")
        return data


class TreadwellNode(Node):
    """Hands over what the robot's topics say, and publishes what its joints are to do."""

    def __init__(self) -> None:
        """Connect to the server and to the topics."""
        super().__init__("treadwell")
        server = str(self.declare_parameter("server", "core.sock").value)
        timeout_s = self.declare_parameter("timeout", 30.0).value
        goal = self.declare_parameter("goal", [2.0, 0.0]).value
        self.core = Core(server, timeout_s, list(goal))
        self.joints = self.core.robot["joints"]
        self.begins_ns = self.tick = self.camera = self.imu = self.feet = self.depth = None
        # This quality of service hears publishers of either kind.
        for kind, topic, hear in (
            (CameraInfo, "depth/camera_info", self.on_camera),
            (Image, "depth/image", self.on_image),
            (Imu, "imu", self.on_imu),
            (Float64MultiArray, "foot_forces", self.on_feet),
            (JointState, "joint_states", self.on_joints),
        ):
            self.create_subscription(kind, topic, hear, qos_profile_sensor_data)
        self.targets = self.create_publisher(JointState, "joint_targets", 10)
        self.state = self.create_publisher(String, "treadwell_state", 10)

    def on_camera(self, info: CameraInfo) -> None:
        """Refuse a camera that is not the robot's."""
        ours = self.core.robot["camera"]
        wanted = [ours[key] for key in ("width", "height", "fx", "fy", "cx", "cy")]
        self.camera = [info.width, info.height, info.k[0], info.k[4], info.k[2], info.k[5]]
        if not np.allclose(self.camera, wanted, rtol=1e-3):
            raise ValueError(f"the camera is {self.camera}, the robot's folder says {wanted}")

    def on_image(self, image: Image) -> None:
        """Keep a depth image: 32FC1 in metres, or 16UC1 in millimetres with 0 for unseen."""
        order = ">" if image.is_bigendian else "<"
        kind, scale = {"32FC1": ("f4", 1.0), "16UC1": ("u2", 0.001)}[image.encoding]
        rows = np.frombuffer(image.data, np.uint8).reshape(image.height, image.step)
        read = rows[:, : image.width * int(kind[1])].copy().view(order + kind)
        depth = (read * scale).astype(np.float32) if scale != 1.0 else read.astype(np.float32)
        self.depth = (stamp_ns(image), np.where(depth > 0.0, depth, np.float32(np.nan)))

    def on_imu(self, imu: Imu) -> None:
        """Keep what the inertial unit measured."""
        self.imu = imu

    def on_feet(self, forces: Float64MultiArray) -> None:
        """Keep eight forces, N: of each foot front left, front right, rear left, rear right."""
        self.feet = np.array(forces.data, float).reshape(2, 4)

    def on_joints(self, joints: JointState) -> None:
        """One control tick."""
        if self.imu is None or self.feet is None or self.camera is None:
            return  # not all senses have spoken yet
        self.begins_ns = stamp_ns(joints) if self.begins_ns is None else self.begins_ns
        now = stamp_ns(joints) - self.begins_ns
        tick = round(now / self.core.robot["tick_ns"])
        if self.tick is not None and tick <= self.tick:
            return  # a robot that tells its joints more often than the core ticks
        self.tick, at = tick, [joints.name.index(name) for name in self.joints]
        rates, force = self.imu.angular_velocity, self.imu.linear_acceleration
        seen, self.depth = self.depth, None
        times, frame = {"type": "observation", "time_ns": now}, {}
        if seen is not None and seen[0] >= self.begins_ns:
            exposed = min(seen[0] - self.begins_ns, now)
            times.update(exposure_ns=exposed, arrival_ns=now)
            frame = {"depth": seen[1]}
        told = self.core.ask(
            times,
            joint_positions=np.array(joints.position)[at],
            joint_velocities=np.array(joints.velocity)[at],
            angular_velocity=np.array([rates.x, rates.y, rates.z]),
            specific_force=np.array([force.x, force.y, force.z]),
            foot_forces=self.feet,
            **frame,
        )
        answer = JointState(name=self.joints)
        answer.header.stamp = joints.header.stamp
        answer.position, answer.velocity = told["position"].tolist(), told["velocity"].tolist()
        answer.effort = told["torque"].tolist()
        self.targets.publish(answer)
        self.state.publish(String(data=told["outcome"] or told["state"]))

    def close(self) -> None:
        """Say goodbye."""
        self.core.ask({"type": "goodbye"})
        self.core.close()


def stamp_ns(message: "JointState | Image") -> int:
    """Return when a message's content was measured, ns."""
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def main() -> None:
    """Run the node until Ctrl-C."""
    rclpy.init()
    node = TreadwellNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.close()


if __name__ == "__main__":
    main()
