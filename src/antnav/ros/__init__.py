"""ROS 2: a planner server for nav2, and what it does without ROS."""
