"""A bag of ROS 2: a run for RViz, Nav2, and whatever reads ROS's own messages; no ROS is needed.

What is in it: `ros2_run`. A message's place in the bag is its arrival.
"""

import sqlite3
from collections.abc import Sequence
from pathlib import Path
from secrets import token_hex
from shutil import rmtree
from typing import Any, Final, Literal, get_args

from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from treadwell.errors import InputError
from treadwell.exports.ros2_messages import Ros2Messages
from treadwell.exports.ros2_run import run_messages

Storage = Literal["mcap", "sqlite3"]
STORAGES: Final[tuple[Storage, ...]] = get_args(Storage)
"""How a bag can be stored. MCAP is what ROS 2 writes since Iron; Humble alone reads sqlite3."""
_URI: Final = "?#%"
_VERSION: Final = 8
"""Of the bag: the newest whose list of topics Humble reads, too."""
_NO_LIMIT: Final = QosTime(9_223_372_036, 854_775_807)
_KEPT: Final = Qos(
    QosHistory.KEEP_LAST,
    1,
    QosReliability.RELIABLE,
    QosDurability.TRANSIENT_LOCAL,
    _NO_LIMIT,
    _NO_LIMIT,
    QosLiveliness.AUTOMATIC,
    _NO_LIMIT,
    avoid_ros_namespace_conventions=False,
)
"""Of topics whose last message is for those, too, who come later."""
_KEPT_TOPICS: Final = ("/tf_static", "/map")


def export_rosbag2(source: Path, out: Path, storage: str = "mcap") -> Sequence[Path]:
    """Write the bag.

    Args:
        source: the run's folder. Of a run without observations the bag has its way and its map.
        out: the bag's folder; it must be empty.
        storage: one of `STORAGES`.

    Raises:
        InputError: the folder holds something, the storage is none, or the run lacks a
            trajectory or the recording that belongs to its observations, or is broken.
        OSError: a file cannot be written.
    """
    if storage not in STORAGES:
        raise InputError(f"--storage: found {storage}; must be one of {', '.join(STORAGES)}")
    if any(out.iterdir()):
        raise InputError(f"--out: {out}: is not empty; a bag has a folder of its own, a new one")
    if storage == "sqlite3" and set(_URI) & set(str(out)):
        raise InputError(f"--out: {out}: SQLite takes no folder with one of {_URI} in its path")
    temporary = out / f".{token_hex(4)}"
    bag = temporary / (out.resolve().name or "bag")
    try:
        _write(bag, source, StoragePlugin[storage.upper()])
        return [file.rename(out / file.name) for file in sorted(bag.iterdir())]
    except sqlite3.Error as error:
        raise OSError(str(error)) from error
    finally:
        rmtree(temporary, ignore_errors=True)


def _write(bag: Path, source: Path, storage: StoragePlugin) -> None:
    ros = Ros2Messages()
    writer = Writer(bag, version=_VERSION, storage_plugin=storage)
    if storage is StoragePlugin.MCAP:
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        connections: dict[str, Any] = {}
        for time_ns, topic, message in run_messages(source, ros):
            if topic not in connections:
                connections[topic] = writer.add_connection(
                    topic,
                    message.__msgtype__,
                    typestore=ros.store,
                    offered_qos_profiles=[_KEPT] if topic in _KEPT_TOPICS else [],
                )
            writer.write(connections[topic], time_ns, ros.packed(message))
