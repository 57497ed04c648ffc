"""The node of the planner server: what comes and goes by ROS. Importing it needs ROS 2."""

from __future__ import annotations

from typing import Any

import rclpy.time
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import ComputePathToPose
from nav2_msgs.msg import Costmap
from nav_msgs.msg import OccupancyGrid, Path
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from tf2_ros import Buffer, TransformException, TransformListener

from antnav.errors import AntnavError
from antnav.ros.convert import fill_path, fill_result, moved, pose_of
from antnav.ros.planner import Pose, Request
from antnav.ros.settings import PARAMETERS, Ended, Goals, planner_of


class PlannerNode(Node):  # type: ignore[misc]  # rclpy has no types where it is not installed
    """Serves ComputePathToPose on /compute_path_to_pose, listens to a map, publishes /plan."""

    def __init__(self) -> None:
        super().__init__("planner_server")
        values = {name: self.declare_parameter(name, default).value for name, default in PARAMETERS.items()}
        algorithms = {
            name: self.declare_parameter(f"{name}.algorithm", "astar").value for name in values["planner_plugins"]
        }
        self.planner = planner_of(values, algorithms)
        self.frame, self.base = values["global_frame"], values["robot_base_frame"]
        self.goals = Goals()
        self.transforms = Buffer()
        self.listener = TransformListener(self.transforms, self)
        latched = QoSProfile(
            depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE
        )
        self.costmap = bool(values["costmap_topic"])
        kind, topic = (Costmap, "costmap_topic") if self.costmap else (OccupancyGrid, "map_topic")
        self.maps = self.create_subscription(kind, values[topic], self.on_map, latched)
        self.plans = self.create_publisher(Path, "plan", 1)
        self.server = ActionServer(
            self,
            ComputePathToPose,
            "compute_path_to_pose",
            self.execute,
            callback_group=ReentrantCallbackGroup(),  # cancels come while a goal runs
            handle_accepted_callback=self.on_accepted,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def on_map(self, message: Any) -> None:
        """Take a map; one that is wrong leaves the old one."""
        try:
            self.planner.take_map(message, costmap=self.costmap)
        except AntnavError as error:
            self.get_logger().error(str(error))

    def on_accepted(self, goal: Any) -> None:
        """Run a goal; those that run end."""
        self.goals.begin(bytes(goal.goal_id.uuid))
        goal.execute()

    def execute(self, goal: Any) -> Any:
        """Answer a goal."""
        asked = goal.request
        start = self.in_map(asked.start) if asked.use_start else self.robot()
        key = bytes(goal.goal_id.uuid)
        request = Request(self.in_map(asked.goal), start, asked.planner_id)
        answer = self.planner.plan(request, Ended(goal, self.goals.event(key)))
        self.goals.end(key)
        result = ComputePathToPose.Result()
        result.path.header.frame_id, result.path.header.stamp = self.frame, self.get_clock().now().to_msg()
        fill_path(result.path, answer, PoseStamped)
        fill_result(result, answer)
        if answer.canceled:
            (goal.canceled if goal.is_cancel_requested else goal.abort)()  # aborted: a newer goal came
        elif answer.error_code:
            self.get_logger().warning(f"{answer.error_code}: {answer.error_msg}")
            goal.abort()
        else:
            self.plans.publish(result.path)
            goal.succeed()
        return result

    def in_map(self, stamped: Any) -> Pose | None:
        """A PoseStamped in the frame of the map; None where there is no transform."""
        frame = stamped.header.frame_id
        if frame in ("", self.frame):
            return pose_of(stamped.pose)
        try:
            found = self.transforms.lookup_transform(self.frame, frame, rclpy.time.Time())
        except TransformException:
            return None
        return moved(pose_of(stamped.pose), found.transform)

    def robot(self) -> Pose | None:
        """Where the robot is; None where nobody knows."""
        try:
            found = self.transforms.lookup_transform(self.frame, self.base, rclpy.time.Time())
        except TransformException:
            return None
        return moved((0.0, 0.0, 0.0), found.transform)
