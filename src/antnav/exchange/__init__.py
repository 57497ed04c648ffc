"""What other programs read: messages and bags of ROS, GeoJSON."""
