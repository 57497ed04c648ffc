"""Bags and messages, read back by rosbags and by mcap, which know nothing of antnav."""

from __future__ import annotations

import math
import sqlite3
from pathlib import Path

import numpy as np
import pytest
import yaml

import antnav as an
from antnav.errors import MapFileError, MapFormatError, MapSizeError, OutputError, ParameterError
from antnav.exchange import bag, messages
from antnav.maps import MapWarning

pytest.importorskip("rosbags", reason='needs pip install "antnav[ros]"')
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer

CELLS = np.array([[1, 0, 2, 3], [0, 0, 0, 0], [0, 3, 0, 1]], np.uint8)
GRID = an.GridMap(CELLS, 0.05, (-1.5, 2.25, 0.4), "hall")


@pytest.fixture(scope="module")
def drive() -> an.Trajectory:
    grid = an.GridMap(np.zeros((40, 60), bool), 0.1, (3.0, -2.0, 0.3))
    problem = an.Problem.from_cells(grid, (20, 5), (8, 50))
    return an.solve(problem, an.astar()).trajectory(radius=0.2, max_speed=0.5, max_acceleration=0.4, start_heading=1.0)


def read(path: Path) -> dict[str, tuple[str, object, bytes]]:
    with AnyReader([path], default_typestore=bag.typestore()) as reader:
        return {
            connection.topic: (connection.msgtype, reader.deserialize(data, connection.msgtype), bytes(data))
            for connection, _, data in reader.messages()
        }


@pytest.mark.parametrize("name", ["drive.mcap", "drive.rosbag2"])
def test_a_trajectory_comes_back_from_a_bag(drive: an.Trajectory, tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    drive.save(path, frame="odom", stamp=1000.25)
    found = read(path)
    assert set(found) == {"/map", "/plan"}
    kind, plan, data = found["/plan"]
    assert kind == "nav_msgs/msg/Path"
    assert data == bytes(bag.typestore().serialize_cdr(plan, kind))
    assert (plan.header.frame_id, plan.header.stamp.sec, plan.header.stamp.nanosec) == ("odom", 1000, 250_000_000)
    poses = [each.pose for each in plan.poses]
    places = np.array([(pose.position.x, pose.position.y, messages.yaw_of(pose.orientation)) for pose in poses])
    np.testing.assert_allclose(places, drive.poses, atol=1e-12)
    norms = [sum(getattr(pose.orientation, axis) ** 2 for axis in "xyzw") for pose in poses]
    np.testing.assert_allclose(norms, 1.0)
    stamps = [each.header.stamp.sec + each.header.stamp.nanosec * 1e-9 for each in plan.poses]
    np.testing.assert_allclose(stamps, 1000.25 + drive.times, atol=1e-8)
    kind, grid, data = found["/map"]
    assert kind == "nav_msgs/msg/OccupancyGrid"
    assert (grid.info.width, grid.info.height, len(grid.data)) == (60, 40, 2400)
    assert data == bytes(bag.typestore().serialize_cdr(grid, kind))


def test_a_path_of_cells_comes_back_from_a_bag(tmp_path: Path) -> None:
    result = an.solve(an.Problem.from_cells(GRID, (1, 0), (2, 2)), an.astar())
    result.save(tmp_path / "plan.mcap", stamp=7)
    _, plan, data = read(tmp_path / "plan.mcap")["/plan"]
    assert data == bytes(bag.typestore().serialize_cdr(plan, messages.PATH))
    points = [(each.pose.position.x, each.pose.position.y) for each in plan.poses]
    assert points == [tuple(point) for point in result.path.points.tolist()]
    assert plan.header.stamp.sec == 7
    assert (an.load_map(tmp_path / "plan.mcap").cells == GRID.cells).all()


def test_a_disk_that_is_full_leaves_what_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    an.save_map(GRID, tmp_path / "hall.mcap")
    an.save_map(GRID, tmp_path / "hall.rosbag2")
    before = (tmp_path / "hall.mcap").read_bytes()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Writer, "write", full)
    for name in ("hall.mcap", "hall.rosbag2"):
        with pytest.raises(OutputError, match="No space left on device"):
            an.save_map(an.GridMap(np.zeros((2, 2), bool)), tmp_path / name)
    assert (tmp_path / "hall.mcap").read_bytes() == before
    assert an.load_map(tmp_path / "hall.rosbag2").shape == GRID.shape
    assert sorted(each.name for each in tmp_path.iterdir()) == ["hall.mcap", "hall.rosbag2"]


def test_the_same_trajectory_gives_the_same_bytes(drive: an.Trajectory, tmp_path: Path) -> None:
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        drive.save(tmp_path / name / "drive.mcap")
    assert (tmp_path / "one/drive.mcap").read_bytes() == (tmp_path / "two/drive.mcap").read_bytes()


def test_mcap_reads_it_too(drive: an.Trajectory, tmp_path: Path) -> None:
    reader = pytest.importorskip("mcap.reader", reason="needs mcap")
    decoder = pytest.importorskip("mcap_ros2.decoder", reason="needs mcap-ros2-support")
    drive.save(tmp_path / "drive.mcap")
    with (tmp_path / "drive.mcap").open("rb") as stream:
        found = {
            channel.topic: (schema.name, message)
            for schema, channel, _, message in reader.make_reader(
                stream, decoder_factories=[decoder.DecoderFactory()]
            ).iter_decoded_messages()
        }
    kind, plan = found["/plan"]
    assert kind == "nav_msgs/msg/Path"
    last = plan.poses[-1].pose.position
    assert (last.x, last.y) == tuple(drive.points[-1].tolist())
    kind, grid = found["/map"]
    assert kind == "nav_msgs/msg/OccupancyGrid"
    assert grid.info.width == 60


@pytest.mark.parametrize("name", ["hall.mcap", "hall.rosbag2"])
def test_a_map_comes_back_from_a_bag(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    an.save_map(GRID, path)
    grid = an.load_map(path)
    np.testing.assert_array_equal(grid.cells, GRID.cells)
    assert (grid.resolution, grid.name) == (0.05, "hall")
    np.testing.assert_allclose(grid.origin, GRID.origin, atol=1e-12)
    message = read(path)["/map"][1]
    rows = np.asarray(message.data).reshape(3, 4)
    assert rows[0].tolist() == [0, 99, 0, 100]  # the bottom row first
    assert rows[2].tolist() == [100, 0, -1, 99]


def test_a_rosbag2_is_replaced_and_nothing_else_is(tmp_path: Path) -> None:
    path = tmp_path / "hall.rosbag2"
    an.save_map(GRID, path)
    an.save_map(an.GridMap(np.zeros((2, 2), bool)), path)
    assert an.load_map(path).shape == (2, 2)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["hall.rosbag2"]
    (tmp_path / "mine.rosbag2").mkdir()
    (tmp_path / "mine.rosbag2/notes.txt").write_text("mine")
    with pytest.raises(OutputError, match="is no bag"):
        an.save_map(GRID, tmp_path / "mine.rosbag2")
    assert (tmp_path / "mine.rosbag2/notes.txt").read_text() == "mine"
    with pytest.raises(OutputError, match="cannot write"):
        an.save_map(GRID, tmp_path / "missing/hall.rosbag2")


def recorded(path: Path, *messages_: tuple[str, str, object], plugin: StoragePlugin = StoragePlugin.MCAP) -> None:
    store = bag.typestore()
    with Writer(path, version=9, storage_plugin=plugin) as writer:
        for time, (topic, kind, message) in enumerate(messages_):
            connection = next((each for each in writer.connections if each.topic == topic), None)
            connection = connection or writer.add_connection(topic, kind, typestore=store)
            writer.write(connection, time, store.serialize_cdr(message, kind))


def costmap(data: np.ndarray, cols: int, rows: int) -> object:
    kinds = bag.typestore().types
    time, pose = kinds["builtin_interfaces/msg/Time"](0, 0), kinds["geometry_msgs/msg/Pose"]
    place = pose(
        kinds["geometry_msgs/msg/Point"](1.0, 2.0, 0.0), kinds["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    )
    meta = kinds["nav2_msgs/msg/CostmapMetaData"](time, time, "master", 0.1, cols, rows, place)
    return kinds["nav2_msgs/msg/Costmap"](kinds["std_msgs/msg/Header"](time, "map"), meta, data)


@pytest.mark.parametrize("plugin", list(StoragePlugin))
def test_nav2s_costmap_is_read(tmp_path: Path, plugin: StoragePlugin) -> None:
    data = np.array([254, 253, 255, 252, 0, 128], np.uint8)
    recorded(tmp_path / "run", ("/costmap", messages.COSTMAP, costmap(data, 3, 2)), plugin=plugin)
    grid = an.load_map(tmp_path / "run")
    assert grid.cells.tolist() == [[0, 0, 0], [1, 3, 2]]
    assert (grid.resolution, grid.origin) == (0.1, (1.0, 2.0, 0.0))


def test_the_last_message_counts_and_topics_are_told_apart(tmp_path: Path) -> None:
    maps = [messages.grid_message(an.GridMap(np.full((2, size), size % 2, bool)), "map", 0.0) for size in (2, 3, 4)]
    kinds = [(topic, each.msgtype, each.message) for topic, each in zip(("/a", "/a", "/b"), maps, strict=True)]
    recorded(tmp_path / "run", *kinds)
    with pytest.raises(ParameterError, match="on /a, /b; name one: topic='/a'"):
        an.load_map(tmp_path / "run")
    assert an.load_map(tmp_path / "run", topic="/a").shape == (2, 3)
    assert an.load_map(tmp_path / "run", topic="/b").shape == (2, 4)
    with pytest.raises(MapFormatError, match=r"topic /c .* it holds /a .*/b"):
        an.load_map(tmp_path / "run", topic="/c")


def test_maps_that_cannot_be_are_refused(tmp_path: Path) -> None:
    recorded(tmp_path / "short", ("/costmap", messages.COSTMAP, costmap(np.zeros(5, np.uint8), 3, 2)))
    with pytest.raises(MapFormatError, match="5 cells: it has 2 x 3"):
        an.load_map(tmp_path / "short")
    recorded(tmp_path / "huge", ("/costmap", messages.COSTMAP, costmap(np.zeros(5, np.uint8), 2**31, 2**31)))
    with pytest.raises(MapSizeError):
        an.load_map(tmp_path / "huge")
    store = bag.typestore()
    text = store.types["std_msgs/msg/String"]("no map")
    recorded(tmp_path / "none", ("/words", "std_msgs/msg/String", text))
    with pytest.raises(MapFormatError, match=r"it holds /words \(std_msgs/msg/String\)"):
        an.load_map(tmp_path / "none")


def test_grades_are_warned_of(tmp_path: Path) -> None:
    message = messages.grid_message(an.GridMap(np.zeros((1, 3), bool)), "map", 0.0)
    message.message.data[:] = (40, 99, 100)
    recorded(tmp_path / "run", (message.topic, message.msgtype, message.message))
    with pytest.warns(MapWarning, match="1 cells of occupancy 1 to 99"):
        assert an.load_map(tmp_path / "run").cells.tolist() == [[0, 3, 1]]
    assert an.load_map(tmp_path / "run", occupied_from=40).cells.tolist() == [[1, 1, 1]]


@pytest.mark.parametrize("name", ["empty.mcap", "short.mcap", "random.db3", "random.bag"])
def test_damaged_bags_are_refused(tmp_path: Path, name: str) -> None:
    an.save_map(GRID, tmp_path / "whole.mcap")
    whole = (tmp_path / "whole.mcap").read_bytes()
    content = {"empty.mcap": b"", "short.mcap": whole[: len(whole) // 2]}.get(name, b"#ROSBAG V2.0\n" + whole)
    (tmp_path / name).write_bytes(content)
    with pytest.raises(MapFormatError, match=name):
        an.load_map(tmp_path / name)


def test_damaged_bytes_end_in_an_error_of_ours_or_in_a_map(tmp_path: Path) -> None:
    draws = np.random.default_rng(7)
    an.save_map(GRID, tmp_path / "a.mcap")
    an.save_map(GRID, tmp_path / "a.rosbag2")
    for whole in (tmp_path / "a.mcap", tmp_path / "a.rosbag2" / "a.db3"):
        content = np.frombuffer(whole.read_bytes(), np.uint8)
        for _ in range(40):
            damaged = content.copy()
            damaged[draws.integers(0, len(content), 4)] = draws.integers(0, 256, 4)
            whole.write_bytes(damaged.tobytes())
            try:
                assert isinstance(an.load_map(whole), an.GridMap)
            except an.AntnavError:
                continue


def test_what_other_topics_hold_does_not_matter(tmp_path: Path) -> None:
    store, message = bag.typestore(), messages.grid_message(GRID, "map", 0.0)
    for plugin in StoragePlugin:
        with Writer(tmp_path / plugin.name, version=9, storage_plugin=plugin) as writer:
            odd = writer.add_connection("/odd", "my_msgs/msg/Odd", msgdef="<<<", rihs01="RIHS01_" + "0" * 64)
            writer.write(odd, 1, b"\0\1\0\0")
            at = writer.add_connection(message.topic, message.msgtype, typestore=store)
            writer.write(at, 0, store.serialize_cdr(message.message, message.msgtype))
        assert an.load_map(tmp_path / plugin.name).shape == GRID.shape


def test_a_bag_of_ros_1(tmp_path: Path) -> None:
    from rosbags import rosbag1
    from rosbags.typesys import Stores, get_typestore

    store, new = get_typestore(Stores.ROS1_NOETIC), messages.grid_message(GRID, "map", 0.0).message
    header = store.types["std_msgs/msg/Header"](0, new.header.stamp, "map")
    old = store.types[messages.GRID](header, new.info, new.data)
    with rosbag1.Writer(tmp_path / "run.bag") as writer:
        at = writer.add_connection("/map", messages.GRID, typestore=store)
        writer.write(at, 0, store.serialize_ros1(old, messages.GRID))
    grid = an.load_map(tmp_path / "run.bag")
    np.testing.assert_array_equal(grid.cells, GRID.cells)
    np.testing.assert_allclose(grid.origin, GRID.origin, atol=1e-12)


def test_humble_can_read_the_metadata(tmp_path: Path) -> None:
    """It takes the profiles as text, which version 9 of the metadata does not have."""
    an.save_map(GRID, tmp_path / "hall.rosbag2")
    about = yaml.safe_load((tmp_path / "hall.rosbag2" / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    (profiles,) = [each["topic_metadata"]["offered_qos_profiles"] for each in about["topics_with_message_count"]]
    assert about["version"] == 8
    assert yaml.safe_load(profiles)[0]["durability"] == 1  # transient local


def test_a_map_that_is_tilted_is_refused(tmp_path: Path) -> None:
    message = messages.grid_message(GRID, "map", 0.0)
    turn = message.message.info.origin.orientation
    object.__setattr__(turn, "x", 0.5)
    recorded(tmp_path / "run", (message.topic, message.msgtype, message.message))
    with pytest.raises(MapFormatError, match="a map lies flat"):
        an.load_map(tmp_path / "run")


def test_stamps_of_today_keep_their_nanoseconds() -> None:
    assert messages.clock(1_700_000_000.25) == (1_700_000_000, 250_000_000)
    assert messages.clock(1_700_000_000.75, 0.5) == (1_700_000_001, 250_000_000)


def test_a_database_that_is_no_bag_and_a_missing_file(tmp_path: Path) -> None:
    sqlite3.connect(tmp_path / "other.db3").execute("create table t (x)").connection.close()
    with pytest.raises(MapFormatError, match=r"other\.db3"):
        an.load_map(tmp_path / "other.db3")
    with pytest.raises(MapFileError):
        an.load_map(tmp_path / "missing.mcap")
    with pytest.raises(ParameterError, match="it is for bags of ROS"):
        an.load_map(Path(an.__file__).parent / "maps/data/equiv20.txt", topic="/map")


def test_ros2_topic_pub_gets_what_the_bag_has(drive: an.Trajectory, tmp_path: Path) -> None:
    drive.save(tmp_path / "drive.ros2.yaml", stamp=5.5)
    found = yaml.safe_load((tmp_path / "drive.ros2.yaml").read_text())
    assert found["header"] == {"stamp": {"sec": 5, "nanosec": 500_000_000}, "frame_id": "map"}
    places = [each["pose"]["position"] for each in found["poses"]]
    assert [(place["x"], place["y"]) for place in places] == [tuple(point) for point in drive.points.tolist()]
    turn = found["poses"][3]["pose"]["orientation"]
    assert 2 * math.atan2(turn["z"], turn["w"]) == pytest.approx(drive.poses[3, 2])


def test_without_rosbags_the_extra_is_named(
    drive: an.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    an.save_map(GRID, tmp_path / "hall.mcap")
    monkeypatch.setattr(bag, "find_spec", lambda _: None)
    for call in (lambda: drive.save(tmp_path / "x.mcap"), lambda: an.load_map(tmp_path / "hall.mcap")):
        with pytest.raises(ParameterError, match=r'pip install "antnav\[ros\]"'):
            call()


@pytest.mark.parametrize("name", ["old.rosbag2", ".mcap"])
def test_odd_names_are_written_twice(drive: an.Trajectory, tmp_path: Path, name: str) -> None:
    for _ in range(2):
        drive.save(tmp_path / name)
    assert [each.name for each in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).is_file() == (name == ".mcap")


def test_a_name_that_is_none_is_refused(drive: an.Trajectory, tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="cannot write"):
        drive.save(tmp_path / "..rosbag2")
