"""`python -m antnav.ros.planner_server`: ComputePathToPose of nav2 by antnav's planners. Untested against a live nav2.

rclpy, tf2_ros and nav2_msgs come with ROS 2 and are imported when the server runs. Parameters: `antnav.ros.settings`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from antnav.errors import AntnavError


def main(args: Sequence[str] | None = None) -> int:
    """Serve until Ctrl-C; 2 where ROS is missing or a parameter is wrong."""
    try:
        import rclpy
        from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor

        from antnav.ros.node import PlannerNode
    except ImportError as error:
        remedy = "source the setup.bash of a ROS 2 with nav2, and use its Python"
        print(f"antnav: error: the planner server needs ROS 2 ({error}); {remedy}", file=sys.stderr)
        return 2
    rclpy.init(args=args)
    try:
        executor = MultiThreadedExecutor()
        executor.add_node(PlannerNode())
        executor.spin()
    except AntnavError as error:
        print(f"antnav: error: {error}", file=sys.stderr)
        return 2
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
