"""Shows a hand in RViz. Handscope publishes its model and its frames; state_publisher:=true computes the frames from /joint_states."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def nodes(context):
    side = LaunchConfiguration("side").perform(context)
    share = Path(get_package_share_directory("handscope_bringup"))
    model = (share / "urdf" / f"ftp_{side}_hand.urdf").read_text()
    return [
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{"robot_description": model}],
            condition=IfCondition(LaunchConfiguration("state_publisher")),
        ),
        Node(
            package="rviz2",
            executable="rviz2",
            arguments=["-d", str(share / "rviz" / f"{side}.rviz")],
            condition=IfCondition(LaunchConfiguration("rviz")),
        ),
    ]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("side", default_value="right", choices=["right", "left"], description="Which hand"),
            DeclareLaunchArgument("rviz", default_value="true", description="Start RViz"),
            DeclareLaunchArgument(
                "state_publisher",
                default_value="false",
                description="Compute the frames from /joint_states, where Handscope does not publish them",
            ),
            OpaqueFunction(function=nodes),
        ]
    )
