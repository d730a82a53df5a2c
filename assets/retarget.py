#!/usr/bin/env python3
"""Lets a hand follow recorded hand tracking: retarget.py RECORDING.csv HOST:PORT [right|left]

RECORDING has a row a frame: seconds, then x, y, z of 21 landmarks in the usual order (wrist, thumb, index, middle, ring, little, each from
the palm to the tip), in any unit that is the same on all three axes: pixels across and down with a depth in metres are none. What a live
tracker gives goes the same way: bends() of its landmarks. A value that cannot be reckoned is null, which leaves that joint alone. Python 3
alone is needed.
"""
import csv, json, math, socket, sys, time

# Radians a finger bends in all its joints, open and as a fist; then the thumb's bend, and how far it is turned before the palm.
FINGER, THUMB_BEND, THUMB_TURN = (0.3, 3.8), (0.3, 1.5), (0.4, 1.2)


def less(a, b):
    return [p - q for p, q in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def angle(a, b):
    return math.atan2(math.hypot(*cross(a, b)), sum(p * q for p, q in zip(a, b)))


def bend(points):
    bones = [less(b, a) for a, b in zip(points, points[1:])]
    return sum(angle(a, b) for a, b in zip(bones, bones[1:]))


def share(value, least_most):
    if not math.isfinite(value):
        return None  # a landmark that is not known: nobody knows where the joint should go, and 0 would be a fist
    least, most = least_most
    return min(1.0, max(0.0, (most - value) / (most - least)))  # 0 bent, 1 open


def bends(points):
    """Six values in the hand's own order: little, ring, middle, index, thumb bend, thumb rotate."""
    wrist = points[0]
    fingers = [share(bend([wrist] + points[at : at + 4]), FINGER) for at in (17, 13, 9, 5)]
    across, along = less(points[5], points[17]), less(points[9], wrist)
    thumb = less(points[2], points[1])
    turned = abs(math.pi / 2 - angle(thumb, cross(across, along)))  # out of the plane of the palm
    return fingers + [share(bend(points[1:5]), THUMB_BEND), share(turned, THUMB_TURN)]


def main(recording, to, side="right"):
    host, port = to.rsplit(":", 1)
    udp, began = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), time.monotonic()
    with open(recording, newline="") as file:
        rows = list(csv.reader(file))[1:]
    if not rows or any(len(row) != 64 for row in rows):
        sys.exit(f"{recording} is no recording: it needs a head and rows of 64 numbers")
    for seq, row in enumerate(rows):
        seconds, numbers = float(row[0]), [float(cell) for cell in row[1:]]
        points = [numbers[at : at + 3] for at in range(0, 63, 3)]
        # Frames in which the hand was not seen are not in the file: nothing is sent, and the hand holds.
        time.sleep(max(0.0, began + seconds - time.monotonic()))
        values = [None if value is None else round(value, 4) for value in bends(points)]
        udp.sendto(json.dumps({"seq": seq, side: values}).encode(), (host, int(port)))


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
