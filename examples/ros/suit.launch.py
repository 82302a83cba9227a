# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Serves a suit to ROS 2, and shows it in RViz:

    ros2 launch examples/ros/suit.launch.py suit:=suit.toml rviz:=true

The forces are then on /<array>/force, the contacts on /contacts (docs/ros.md)."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    suit, port, rviz = (LaunchConfiguration(name) for name in ("suit", "port", "rviz"))
    return LaunchDescription(
        [
            DeclareLaunchArgument("suit", description="suit.toml: arrays with their sources and models"),
            DeclareLaunchArgument(
                "port", default_value="8080", description="of the page in the browser; 0: any that is free"
            ),
            DeclareLaunchArgument("rviz", default_value="false", description="true: shows /suit/points"),
            # Takes ROS_DOMAIN_ID and ROS_LOCALHOST_ONLY from the environment, as nodes do.
            ExecuteProcess(
                cmd=["dermis", "serve", "--suit", suit, "--port", port, "--dds"],
                output="screen",
                respawn=True,
                respawn_delay=2.0,
            ),
            ExecuteProcess(cmd=["rviz2", "--fixed-frame", "suit"], condition=IfCondition(rviz)),
        ]
    )
