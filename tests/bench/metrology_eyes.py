"""Files that other programs open, and the same values from each of them; for metrology_figures.py."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import time
import zipfile
import zlib

import numpy as np

from metrology_artefacts import gsf, write_gsf

TEXTURE = {"measurements": {"t": {"kind": "areal", "surface": "measured", "parameters": ["Sa", "Sq", "Ssk", "Sku", "Sz"]}}}


def opened_by_gwyddion(plant, file):
    """(what Gwyddion's library says of the file, its heights in the file's unit with NaN for holes); None if refused."""
    gwy, heights = plant.work / f"{file.name}.gwy", plant.work / f"{file.name}.f64"
    environment = {**os.environ, "HOME": str(plant.work)}
    done = subprocess.run(["gwyddion", f"--convert-to-gwy={gwy}", str(file)], capture_output=True, env=environment)
    if done.returncode != 0 or not gwy.exists():
        return None, None
    said = json.loads(plant.run(plant.work / "gwyddion_params", gwy, heights).stdout)
    return said, np.fromfile(heights).reshape(said["height"], said["width"])


def same_heights(found, z_um):
    return found is not None and found.shape == z_um.shape and np.array_equal(np.isnan(found), np.isnan(z_um)) and bool(
        np.nanmax(np.abs(found * 1e6 - z_um)) < 1e-4)


def same_scale(said, z_um):
    height, width = z_um.shape
    return said["xy_unit"] == said["z_unit"] == "m" and abs(said["x_real"] / (width * 1e-6) - 1) < 1e-9 and abs(
        said["y_real"] / (height * 1e-6) - 1) < 1e-9


def in_gwyddion(plant, out, slices):
    """The letter F with a hole in its upper left, in each format, and three maps' parameters."""
    z = gsf(out / "height.gsf")
    truth = gsf(slices / "truth/truth.gsf")
    valid = ~np.isnan(z)
    upright = all(np.corrcoef(z[valid], truth[valid])[0, 1] > np.corrcoef(z[valid], other[valid])[0, 1] + 0.1
                  for other in (truth[::-1], truth[:, ::-1], truth[::-1, ::-1]))
    z[30:55, 20:80] = np.nan
    source = write_gsf(plant.work / "holes.gsf", z)
    files, good = ["gsf", "x3p", "sdf", "tiff"], []
    for form in ("gsf", "x3p", "sdf"):
        file = plant.work / f"holed.{form}"
        plant.run(plant.fvdctl, "export", source, "--format", form, "--out", file)
        said, found = opened_by_gwyddion(plant, file)
        if said and upright and same_scale(said, z) and same_heights(found, z):
            good.append(form)
    # Gwyddion knows no scale of a float TIFF.
    if upright and same_heights(opened_by_gwyddion(plant, out / "height.tiff")[1], gsf(out / "height.gsf")):
        good.append("tiff")
    worst = 0.0
    _, rough, _ = plant.measured("rough", TEXTURE)
    for file in (source, out / "height.gsf", rough / "height.gsf"):
        said, _ = opened_by_gwyddion(plant, file)
        values = {key: value["value"] for key, value in plant.of_file(file, TEXTURE)["measurements"]["t"]["values"].items()}
        for key, name in (("Sa_um", "Sa"), ("Sq_um", "Sq"), ("Sz_um", "Sz")):
            worst = max(worst, abs(said[name] * 1e6 / values[key] - 1))
        worst = max(worst, abs(said["Ssk"] - values["Ssk"]), abs(said["Sku_less_3"] + 3 - values["Sku"]))
    return {"gwyddion_files": len(files), "gwyddion_files_ok": len(good), "gwyddion_param_worst": float(f"{worst:.2e}")}


def digests(file):
    """Whether the digests in an X3P are those of its entries."""
    def md5(data):
        return hashlib.md5(data, usedforsecurity=False).hexdigest()

    with zipfile.ZipFile(file) as archive:
        main = archive.read("main.xml")
        text = main.decode()
        stated = {key: re.search(f"<{key}>([^<]*)</{key}>", text).group(1).lower() for key in (
            "PointDataLink", "MD5ChecksumPointData", "ValidPointsLink", "MD5ChecksumValidPoints", "ChecksumFile")}
        return (archive.namelist()[0] == "main.xml"
                and archive.read(stated["ChecksumFile"]).decode().split()[0].lower() == md5(main)
                and md5(archive.read(stated["PointDataLink"])) == stated["MD5ChecksumPointData"]
                and md5(archive.read(stated["ValidPointsLink"])) == stated["MD5ChecksumValidPoints"])


def png_is_drawn(file):
    """Whether the picture has many different pixels."""
    data = file.read_bytes()
    pixels, at = b"", 8
    while at < len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        pixels += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += length + 12
    return len(set(zlib.decompress(pixels))) > 60


def meshes(plant, out):
    figures = {}
    ply, stl, picture = plant.work / "f.ply", plant.work / "f.stl", plant.work / "f.png"
    plant.run(plant.fvdctl, "export", out, "--format", "ply", "--out", ply)
    plant.run(plant.fvdctl, "export", out, "--format", "stl", "--out", stl)
    # Without a display f3d crashes.
    drawn = subprocess.run(["xvfb-run", "-a", "f3d", str(ply), f"--output={picture}", "--resolution=400,300"], capture_output=True,
                           timeout=120, env={**os.environ, "HOME": str(plant.work)})
    figures["ply_ok"] = drawn.returncode == 0 and picture.exists() and png_is_drawn(picture) and (
        b"unit mm" in ply.read_bytes()[:2000])
    text = subprocess.run(["admesh", str(stl)], capture_output=True, text=True).stdout

    def count(label):
        found = re.search(label + r"\s*:\s*(\d+)", text)
        return int(found.group(1)) if found else None

    height, width = gsf(out / "height.gsf").shape
    # The letter has no holes: two facets a cell, and the field's border is all that is open.
    open_edges = count("Facets with 1 disconnected edge") + 2 * count("Facets with 2 disconnected edges")
    figures["stl_degenerate_facets"] = count("Degenerate facets")
    figures["stl_ok"] = (figures["stl_degenerate_facets"] == 0 and count("Number of facets") == 2 * (height - 1) * (width - 1)
                         and open_edges == 2 * (height - 1) + 2 * (width - 1) and b"unit mm" in stl.read_bytes()[:80])
    return figures


def report(plant, out, evaluation):
    pdf = plant.work / "report.pdf"
    start = time.monotonic()
    plant.run(plant.fvdctl, "report", out, "--out", pdf)
    figures = {"report_s": round(time.monotonic() - start, 2)}
    pages = re.search(r"Pages:\s*(\d+)", plant.run("pdfinfo", pdf).stdout).group(1)
    text = plant.run("pdftotext", "-layout", pdf, "-").stdout.replace("\u2212", "-")
    found = all(any(f"{value['value']:.{digits}f}" in text for digits in range(1, 7))
                for made in evaluation["measurements"].values() for value in made["values"].values()
                if value.get("value") is not None)
    plant.run("pdftoppm", "-r", "50", "-gray", "-singlefile", pdf, plant.work / "page")
    grey = np.frombuffer((plant.work / "page.pgm").read_bytes()[20:], np.uint8)
    figures["pdf_ok"] = pages == "1" and found and 0.02 < float(np.mean(grey < 200)) < 0.9 and len(np.unique(grey)) > 30
    return figures


def slices_by_tifffile(plant, out, slices):
    """The slices, recorded as a job keeps them, through an OME-TIFF and tifffile."""
    try:
        import tifffile
    except ImportError:
        return {"ome_ok": None, "why": {"ome_ok": "python3-tifffile is not installed"}}
    job, file = plant.work / "kept", plant.work / "f.ome.tif"
    shutil.copytree(out, job)
    (job / "slices").mkdir()
    recorded = sorted(slices.glob("slice_*.pgm"))
    for number, slice_file in enumerate(recorded):
        shutil.copy(slice_file, job / "slices" / f"slice_{number:05}.pgm")
    z_um = np.loadtxt(slices / "z.txt") + 0.01 * np.sin(np.arange(len(recorded)))  # the stage is where it is
    np.savetxt(job / "slices/z.txt", z_um, fmt="%.17g")
    plant.run(plant.fvdctl, "export", job, "--format", "ome-tiff", "--out", file)
    height, width = gsf(out / "height.gsf").shape
    with tifffile.TiffFile(file) as tiff:
        series = tiff.series[0]
        pixels = tifffile.xml2dict(tiff.ome_metadata)["OME"]["Image"]["Pixels"]
        read = series.asarray()
        good = tiff.is_ome and series.axes == "ZYX" and read.shape == (len(recorded), height, width) and read.dtype == np.uint8
        good = good and pixels["DimensionOrder"] == "XYZCT" and pixels["PhysicalSizeX"] == pixels["PhysicalSizeY"] == 1
        good = good and pixels["PhysicalSizeXUnit"] == "\u00b5m" and pixels["SignificantBits"] == 8
        good = good and abs(pixels["PhysicalSizeZ"] - (z_um[-1] - z_um[0]) / (len(z_um) - 1)) < 0.01
        good = good and [plane["PositionZ"] for plane in pixels["Plane"]] == z_um.tolist()
        for number, slice_file in enumerate(recorded):
            good = good and read[number].tobytes() == slice_file.read_bytes()[-height * width:]
    return {"ome_ok": bool(good)}


def others_eyes(plant):
    plan = {"surfaces": {"level": {"steps": [{"op": "level"}]}},
            "measurements": {"t": {"kind": "areal", "surface": "level", "parameters": ["Sa", "Sq", "Sz", "Sku"]},
                             "p": {"kind": "profile", "from_um": [20, 180], "to_um": [460, 180], "parameters": ["Ra"]}}}
    evaluation, out, slices = plant.measured("letter_f", plan)
    recipe = out.with_name(f"recipe_of_{out.name}.json")
    folder = json.loads(plant.run(plant.fvdctl, "measure", out, "--recipe", recipe, "--json").stdout)
    figures, same, worst_s = {"online_equals_offline": folder == evaluation}, True, 0.0
    for form in ("x3p", "gsf", "sdf"):
        file = plant.work / f"f.{form}"
        start = time.monotonic()
        plant.run(plant.fvdctl, "export", out, "--format", form, "--out", file)
        worst_s = max(worst_s, time.monotonic() - start)
        again = json.loads(plant.run(plant.fvdctl, "measure", file, "--recipe", recipe, "--json").stdout)
        for name, made in evaluation["measurements"].items():
            for key, was in made["values"].items():
                same = same and was.get("value") == again["measurements"][name]["values"][key].get("value")
    figures["export_worst_s"] = round(worst_s, 2)
    figures["files_give_the_same_values"] = same
    figures["md5_ok"] = digests(plant.work / "f.x3p")
    for part in (lambda: in_gwyddion(plant, out, slices), lambda: meshes(plant, out), lambda: report(plant, out, evaluation),
                 lambda: slices_by_tifffile(plant, out, slices)):
        figures.update(part())
    return figures
