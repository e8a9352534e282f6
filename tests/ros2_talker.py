"""A robot that tells a recorded run on the topics of ROS 2, tick by tick, and keeps the answers.

    python3 ros2_talker.py told.npz        # writes told.npz.heard.npz

It runs in the interpreter of ROS 2, which has no treadwell; `test_ros2_node.py` begins it.
"""

import sys
import time
from collections.abc import Callable

import numpy as np
import rclpy
from builtin_interfaces.msg import Time
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image, Imu, JointState
from std_msgs.msg import Float64MultiArray

BEGAN_NS = 1_700_000_000_123_456_789
BETWEEN_S = 0.005
"""What is told of one topic arrives before what is told of another so much later."""
PATIENCE_S = 60.0


class Talker(Node):
    """Publishes what a robot would, and hears what its joints shall do."""

    def __init__(self, told: dict) -> None:
        """Join the topics."""
        super().__init__("robot")
        self.told, self.answers = told, []
        pictures = qos_profile_sensor_data
        self.camera = self.create_publisher(CameraInfo, "depth/camera_info", pictures)
        self.image = self.create_publisher(Image, "depth/image", pictures)
        self.imu = self.create_publisher(Imu, "imu", pictures)
        self.feet = self.create_publisher(Float64MultiArray, "foot_forces", 10)
        self.joints = self.create_publisher(JointState, "joint_states", 10)
        self.create_subscription(JointState, "joint_targets", self.answers.append, 10)

    def wait_until(self, done: "Callable[[], bool]") -> None:
        """Spin until something is so."""
        end = time.monotonic() + PATIENCE_S
        while not done():
            if time.monotonic() > end:
                raise SystemExit("the node says nothing")
            rclpy.spin_once(self, timeout_sec=0.05)

    def tell(self, tick: int, picture: "int | None") -> None:
        """Publish one tick, and wait for its answer."""
        told, stamp = self.told, stamped(self.told["time_ns"][tick])
        if picture is not None:
            depth = told["depth"][picture]
            image = Image(height=depth.shape[0], width=depth.shape[1], encoding="32FC1")
            image.header.stamp = stamped(told["exposure_ns"][picture])
            image.step, image.data = 4 * depth.shape[1], depth.astype("<f4").tobytes()
            self.image.publish(image)
            time.sleep(10 * BETWEEN_S)
        imu = Imu()
        imu.header.stamp = stamp
        turn, force = imu.angular_velocity, imu.linear_acceleration
        turn.x, turn.y, turn.z = told["angular_velocity"][tick].tolist()
        force.x, force.y, force.z = told["specific_force"][tick].tolist()
        self.imu.publish(imu)
        self.feet.publish(Float64MultiArray(data=told["foot_forces"][tick].tolist()))
        time.sleep(BETWEEN_S)
        joints = JointState(name=told["names"][::-1].tolist())
        joints.header.stamp = stamp
        joints.position = told["joint_positions"][tick][::-1].tolist()
        joints.velocity = told["joint_velocities"][tick][::-1].tolist()
        before = len(self.answers)
        self.joints.publish(joints)
        self.wait_until(lambda: len(self.answers) > before)


def stamped(time_ns: int) -> Time:
    """Return a time of the run on the robot's clock."""
    seconds, rest = divmod(BEGAN_NS + int(time_ns), 10**9)
    return Time(sec=seconds, nanosec=rest)


def main() -> None:
    """Tell the whole run."""
    told = np.load(sys.argv[1])
    rclpy.init()
    robot = Talker(told)
    everyone = (robot.camera, robot.image, robot.imu, robot.feet, robot.joints)
    robot.wait_until(lambda: all(one.get_subscription_count() for one in everyone))
    robot.wait_until(lambda: robot.count_publishers("joint_targets"))
    info = CameraInfo(height=int(told["camera"][1]), width=int(told["camera"][0]))
    fx, fy, cx, cy = told["camera"][2:].tolist()
    info.k = [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]
    robot.camera.publish(info)
    time.sleep(10 * BETWEEN_S)
    pictured = told["pictured"].tolist()
    for tick in range(len(told["time_ns"])):
        robot.tell(tick, pictured.index(tick) if tick in pictured else None)
    names = ("position", "velocity", "effort")
    heard = {name: np.array([getattr(a, name) for a in robot.answers]) for name in names}
    np.savez(sys.argv[1] + ".heard.npz", **heard)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
