"""A node of ROS 2 between a robot's topics and `treadwell serve`.

    treadwell serve --robot qrio --socket core.sock &
    python examples/ros2_node.py --ros-args -p server:=core.sock -p goal:="[2.0, 0.0]"

Each joint state is a control tick, 10 ms after the last one; what came before it of the other
topics goes with it. Stamps are of one clock.
"""

from pathlib import Path

import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, Image, Imu, JointState
from std_msgs.msg import Float64MultiArray, String

from treadwell.observation import Frame, Observation
from treadwell.serving.client import Client


class TreadwellNode(Node):
    """Hands over what the robot's topics say, and publishes what its joints are to do."""

    def __init__(self) -> None:
        """Connect to the server and to the topics."""
        super().__init__("treadwell")
        server = self.declare_parameter("server", "core.sock").value
        goal = self.declare_parameter("goal", [2.0, 0.0]).value
        self.core = Client(Path(server), goal={"position": list(goal)})
        self.joints = self.core.robot["joints"]
        self.begins_ns = self.camera = self.imu = self.feet = self.depth = None
        self.create_subscription(CameraInfo, "depth/camera_info", self.on_camera, 10)
        self.create_subscription(Image, "depth/image", self.on_image, 10)
        self.create_subscription(Imu, "imu", self.on_imu, 10)
        self.create_subscription(Float64MultiArray, "foot_forces", self.on_feet, 10)
        self.create_subscription(JointState, "joint_states", self.on_joints, 10)
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
        self.feet = np.array(forces.data).reshape(2, 4)

    def on_joints(self, joints: JointState) -> None:
        """One control tick."""
        if self.imu is None or self.feet is None or self.camera is None:
            return  # not all senses have spoken yet
        self.begins_ns = stamp_ns(joints) if self.begins_ns is None else self.begins_ns
        now, at = stamp_ns(joints) - self.begins_ns, [joints.name.index(n) for n in self.joints]
        seen, self.depth = self.depth, None
        exposed = None if seen is None else seen[0] - self.begins_ns
        frame = None if exposed is None or exposed < 0 else Frame(exposed, now, seen[1])
        turn, force = self.imu.angular_velocity, self.imu.linear_acceleration
        positions, velocities = (np.array(a)[at] for a in (joints.position, joints.velocity))
        rates, forces = np.array([turn.x, turn.y, turn.z]), np.array([force.x, force.y, force.z])
        told = self.core.tick(
            Observation(now, positions, velocities, rates, forces, self.feet, frame)
        )
        answer = JointState(name=self.joints)
        answer.header.stamp = joints.header.stamp
        answer.position, answer.velocity = told.position.tolist(), told.velocity.tolist()
        answer.effort = told.torque.tolist()
        self.targets.publish(answer)
        self.state.publish(String(data=told.outcome or told.state))


def stamp_ns(message: JointState | Image) -> int:
    """Return when a message's content was measured, ns."""
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


if __name__ == "__main__":
    rclpy.init()
    rclpy.spin(TreadwellNode())
