#!/usr/bin/env python3
"""Results that no scan gave, for what is looked at in pages: as large as wanted, every height known.

made_result.py STATE JOB WIDTH HEIGHT HEIGHTS [COPIES]
  STATE    state folder of an fvd that does not run
  JOB      a completed job there: the made ones are as it, with other maps
  HEIGHTS  file that gets the heights as float32, little endian, row by row from the top, metres, NaN = hole
Prints {"jobs": [ids], "pitch_um": [x, y]}. Each of the COPIES (default 1) has a folder and a row of its own.
"""

import array
import contextlib
import hashlib
import json
import math
import os
import pathlib
import random
import sqlite3
import struct
import sys
import zlib

PITCH_UM = (0.5, 0.625)  # not square, so that who mixes them up is seen
KNOWN_ROWS = 64  # of a large map; they are repeated with a step, for a program of this language takes long for more
LARGE_POINTS = 4_000_000
LOW_PROMINENCE = 1


def heights_of(width, height, seed=1):
    """Rows of float32 in metres: waves, roughness, spikes, round holes and single ones."""
    pick = random.Random(seed)
    rows = KNOWN_ROWS if width * height > LARGE_POINTS else height
    holes = [(pick.uniform(0, width), pick.uniform(0, rows), pick.uniform(0.01, 0.04) * min(width, rows)) for _ in range(12)]
    made = []
    for y in range(rows):
        wave = 20e-6 * math.sin(y / 37)
        row = array.array("f", (wave + 5e-6 * math.sin(x / 53) + 1e-7 * pick.random() for x in range(width)))
        for hole_x, hole_y, radius in holes:
            half = math.sqrt(max(0.0, radius**2 - (y - hole_y) ** 2))
            for x in range(max(0, math.ceil(hole_x - half)), min(width, math.ceil(hole_x + half))):
                row[x] = math.nan
        for _ in range(width // 100):
            row[pick.randrange(width)] = math.nan
        row[pick.randrange(width)] = 90e-6
        made.append(row)
    return [made[y % rows] for y in range(height)]


def tiff_of(rows, width):
    """As height_tiff of daemon/export writes it: 32-bit floats, not compressed, one strip a few rows."""
    height, per_strip = len(rows), max(1, 8192 // (4 * width))
    strips = [b"".join(row.tobytes() for row in rows[y:y + per_strip]) for y in range(0, height, per_strip)]
    offsets, at = [], 8
    for strip in strips:
        offsets.append(at)
        at += len(strip)
    arrays = struct.pack(f"<{len(strips)}I", *offsets) + struct.pack(f"<{len(strips)}I", *map(len, strips))
    several = len(strips) > 1
    tags = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 32), (259, 3, 1, 1), (262, 3, 1, 1),
            (273, 4, len(strips), at if several else offsets[0]), (274, 3, 1, 1), (277, 3, 1, 1), (278, 4, 1, per_strip),
            (279, 4, len(strips), at + 4 * len(strips) if several else len(strips[0])), (339, 3, 1, 3)]
    directory = struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", *tag) for tag in tags) + bytes(4)
    place = at + len(arrays)
    return struct.pack("<2sHI", b"II", 42, place) + b"".join(strips) + arrays + directory


def png_of(rows, width, bits):
    """rows: bytes each, big endian, grey."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, len(rows), bits, 0, 0, 0, 0)
    packed = zlib.compress(b"".join(b"\0" + row for row in rows), 1)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def each_once(rows, make):
    """make(row) of all rows; those that are one object are made once."""
    known = {}
    for row in rows:
        if id(row) not in known:
            known[id(row)] = make(row)
    return [known[id(row)] for row in rows]


def files_of(rows, width):
    holes = each_once(rows, lambda row: [math.isnan(z) for z in row])
    sigmas = each_once(rows, lambda row: array.array("f", (math.nan if math.isnan(z) else 2e-8 for z in row)))
    masks = each_once(holes, lambda row: struct.pack(f">{width}H", *(LOW_PROMINENCE if hole else 0 for hole in row)))
    textures = each_once(rows, lambda row: bytes(0 if math.isnan(z) else 128 + int(1e6 * z) % 100 for z in row))
    return {"height.tiff": tiff_of(rows, width), "sigma.tiff": tiff_of(sigmas, width),
            "mask.png": png_of(masks, width, 16), "texture.png": png_of(textures, width, 8)}


def digest_of(data):
    return hashlib.sha256(data).hexdigest()


def record_of(text, rows, width, files, **job):
    """result.json of the other job with what is different."""
    result = json.loads(text)
    valid = sum(each_once(rows, lambda row: sum(not math.isnan(z) for z in row)))
    points = width * len(rows)
    result["job"].update(job)
    result["focus"].update(width_px=width, height_px=len(rows))
    result["focus"].update(pixel_pitch_x_um=PITCH_UM[0], pixel_pitch_y_um=PITCH_UM[1])
    values = result["values"]
    values.update(points=points, valid_points=valid, valid_fraction=round(valid / points, 6))
    values["hole_points"] = dict.fromkeys(values["hole_points"], 0) | {"low_prominence": points - valid}
    result["files"] = [{"name": name, "state": "written", "size_bytes": len(data), "sha256": digest_of(data)}
                       for name, data in files.items()]
    return json.dumps(result, indent=2) + "\n"


def add_job(database, like, folder, text, job_id, seq):
    """A row as the other job's, completed and acknowledged."""
    row = dict(like) | {"job_id": job_id, "client": "made", "seq": seq, "part_id": f"made-{seq}", "acknowledged": 1,
                        "result_dir": str(folder), "result_json": text, "files_pending": 0}
    row.pop("number")
    database.execute(f"INSERT INTO jobs ({', '.join(row)}) VALUES ({', '.join('?' * len(row))})", tuple(row.values()))


def make_results(state, like_id, width, height, copies=1, rows=None):
    """The ids of the made jobs and their rows of heights. What one folder has, the others have as links to the same data."""
    rows = rows or heights_of(width, height)
    files = files_of(rows, width)
    ids = []
    with contextlib.closing(sqlite3.connect(pathlib.Path(state) / "fvd.sqlite")) as database:
        database.row_factory = sqlite3.Row
        like = database.execute("SELECT * FROM jobs WHERE job_id = ?", (like_id,)).fetchone()
        if like is None or not like["result_json"]:
            raise ValueError(f"{like_id} has no result")
        first = database.execute("SELECT COUNT(*) FROM jobs WHERE client = 'made'").fetchone()[0] + 1
        for seq in range(first, first + copies):
            job_id = f"{like_id[:-6]}{900000 + seq}"
            folder = pathlib.Path(like["result_dir"]).parent / job_id
            folder.mkdir()
            for name, data in files.items():
                if ids:
                    os.link(folder.parent / ids[0] / name, folder / name)
                else:
                    (folder / name).write_bytes(data)
            text = record_of(like["result_json"], rows, width, files, job_id=job_id, seq=seq, part_id=f"made-{seq}")
            (folder / "result.json").write_text(text)
            add_job(database, like, folder, text, job_id, seq)
            ids.append(job_id)
        database.commit()
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    return ids, rows


def main():
    state, like_id, width, height, target = sys.argv[1:6]
    ids, rows = make_results(state, like_id, int(width), int(height), int(sys.argv[6]) if len(sys.argv) > 6 else 1)
    with open(target, "wb") as file:
        for row in rows:
            row.tofile(file)
    print(json.dumps({"jobs": ids, "pitch_um": PITCH_UM}))


if __name__ == "__main__":
    main()
