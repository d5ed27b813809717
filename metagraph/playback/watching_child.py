"""Measure pieces of plans for `metagraph.playback.played_poses`, which runs this module as a process.

It receives the project and the plans, then one piece after the other, pickled by the parent, and sends what
is seen of each.
"""

from __future__ import annotations

import pickle

from metagraph.common.child_channel import connect_to_parent
from metagraph.playback.played_poses import PoseWatcher


def main() -> None:
    channel = connect_to_parent()
    watchers: dict[int, PoseWatcher] = {}
    try:
        project, plans = pickle.loads(channel.receive())
        while True:
            plan, times = pickle.loads(channel.receive())
            if plan not in watchers:
                watchers[plan] = PoseWatcher(project, plans[plan])
            channel.send(pickle.dumps(watchers[plan].watch(times)))
    except (EOFError, OSError):
        return  # the parent has all it wanted, or has ended


if __name__ == "__main__":
    main()
