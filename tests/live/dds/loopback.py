# SPDX-License-Identifier: Apache-2.0
# SPDX-FileCopyrightText: 2026 The dermis authors
"""Publishers and subscribers of DDS that no other machine hears."""

import os

# Of ROS 2, and of Cyclone DDS.
ENVIRONMENT = {
    **os.environ,
    "ROS_LOCALHOST_ONLY": "1",
    "CYCLONEDDS_URI": """<CycloneDDS><Domain>
        <General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
          <AllowMulticast>false</AllowMulticast></General>
        <Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>60</MaxAutoParticipantIndex>
          <Peers><Peer address="127.0.0.1"/></Peers></Discovery>
      </Domain></CycloneDDS>""",
}


def subscription(topic, kind):
    """As cyclone_reader takes it: ("/contacts", "dermis_msgs/Contacts")."""
    package, name = kind.split("/")
    return f"rt{topic}={package}::msg::dds_::{name}_"
