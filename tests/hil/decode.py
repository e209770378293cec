"""decode.py LOG: what python-can reads in a candump log: frames, and of each identifier how many and
how far apart. Needs python3-can."""
import collections
import sys

import can

times = collections.defaultdict(list)
total = extended = 0
for message in can.LogReader(sys.argv[1]):
    total += 1
    extended += message.is_extended_id
    times[message.arbitration_id, message.is_extended_id].append(message.timestamp)
print(f"python-can: frames: {total}")
print(f"python-can: frames with an identifier of 29 bits: {extended}")
print(f"python-can: identifiers: {len(times)}")
for (identifier, is_extended), at in sorted(times.items()):
    mean = 1000 * (at[-1] - at[0]) / max(1, len(at) - 1)
    longest = 1000 * max((b - a for a, b in zip(at, at[1:])), default=0)
    width = 8 if is_extended else 3
    print(f"python-can: {identifier:0{width}X}: {len(at)} frames, {mean:.1f} ms apart, longest {longest:.1f} ms")
