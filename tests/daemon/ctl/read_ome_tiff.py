"""What tifffile reads of an OME-TIFF, as one JSON object. usage: read_ome_tiff.py FILE. Exit status 77 without tifffile."""

import json
import sys

try:
    import tifffile
except ImportError:
    sys.exit(77)

with tifffile.TiffFile(sys.argv[1]) as tiff:
    series = tiff.series[0]
    pixels = series.asarray()
    described = tifffile.xml2dict(tiff.ome_metadata)["OME"]["Image"]
    print(json.dumps({"is_ome": tiff.is_ome, "is_bigtiff": tiff.is_bigtiff, "pages": len(tiff.pages), "axes": series.axes,
                      "shape": list(pixels.shape), "dtype": str(pixels.dtype), "pixels": pixels.ravel().tolist(),
                      "image": described}))
