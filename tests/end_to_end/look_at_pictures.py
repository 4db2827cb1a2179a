#!/usr/bin/python3
"""Fails unless the pictures that viewer_test.sh took show something: look_at_pictures.py FOLDER"""
import pathlib
import sys

from PIL import Image, ImageChops

# What must be seen: least number of colours in a part of the picture (left, top, right, bottom as shares).
PARTS = {
    "off-screen": (60, (0, 0, 1, 1)),
    "joined": (60, (0, 0, 1, 1)),
    "log": (4, (0, 0, 1, 1)),
    "landmarks": (6, (0, 0, 1, 1)),
    "landmarks-joined": (4, (0, 0, 1, 1)),
    "viewer-start": (60, (0.2, 0.1, 0.7, 0.8)),
    "viewer-timeline": (60, (0.2, 0.1, 0.7, 0.8)),
    "viewer-selected": (60, (0.2, 0.1, 0.7, 0.8)),
    "viewer-joined": (60, (0.2, 0.1, 0.7, 0.8)),
    "viewer-help": (60, (0.2, 0.1, 0.7, 0.8)),
    "rawlogviewer": (30, (0.4, 0.3, 1, 1)),
    "sceneviewer": (30, (0, 0.1, 1, 1)),
}
DIFFERENT = [("landmarks", "landmarks-joined"), ("viewer-start", "viewer-timeline"), ("viewer-timeline", "viewer-selected"), ("viewer-joined", "viewer-help")]


def colours(picture, part):
    width, height = picture.size
    left, top, right, bottom = part
    box = (int(left * width), int(top * height), int(right * width), int(bottom * height))
    return len(set(picture.crop(box).getdata()))


def main():
    folder = pathlib.Path(sys.argv[1])
    pictures = {name: Image.open(folder / f"{name}.png").convert("RGB") for name in PARTS}
    failed = False
    for name, (least, part) in PARTS.items():
        seen = colours(pictures[name], part)
        print(f"{name}: {seen} colours")
        failed |= seen < least
    for a, b in DIFFERENT:
        if ImageChops.difference(pictures[a], pictures[b]).getbbox() is None:
            print(f"{a} and {b} show the same", file=sys.stderr)
            failed = True
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
