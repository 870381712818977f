"""Which buildings of a folder are for development and which for tests: odd and even ones."""
import re

DEVELOPMENT, TEST, ALL = PARTS = ["development", "test", "all"]
SUFFIXES = {".obj", ".off", ".ply", ".stl", ".glb"}


def part_of(stem, place):
    """By the last number in a file's name; without one by its place in the sorted folder, from 1."""
    numbers = re.findall(r"\d+", stem)
    return DEVELOPMENT if int(numbers[-1] if numbers else place) % 2 else TEST


def files_of_part(folder, part):
    """Meshes and points of a folder, sorted by name; none where there is no folder."""
    files = sorted(f for f in folder.glob("*") if f.suffix.lower() in SUFFIXES)
    return [f for place, f in enumerate(files, start=1) if part in (ALL, part_of(f.stem, place))]
