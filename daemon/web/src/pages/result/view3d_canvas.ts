// The surface in 3D: coarse while it turns, fine when it rests.
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { html } from "../../lib/html.ts";
import { type Range, kGreyTable, kViridisTable } from "../../surface/colours.ts";
import { GlSurface, frameAt } from "../../surface/gl_surface.ts";
import { type Mesh, meshOf } from "../../surface/height_mesh.ts";
import type { Tile } from "../../surface/height_tile.ts";
import type { MapSize, Size } from "../../surface/map_view.ts";
import { reliefPixels } from "../../surface/relief.ts";
import { type Look, matrixOf } from "../../surface/view_angles.ts";

export interface Layer {
  heights: Tile;
  colours: Tile;  // of the same shape
}

interface Props {
  coarse: Layer;
  fine: Layer;
  map: MapSize;
  range: Range;  // of the colours, in their tile's unit
  heights_um: Range;
  byTexture: boolean;
  exaggeration: number;
  look: Look;
  moving: boolean;
  canvas: Size;
  onMode: (mode: "gl" | "relief") => void;
}

export function View3dCanvas(props: Props) {
  const { coarse, fine, map, range, heights_um, byTexture, exaggeration, look, moving, canvas, onMode } = props;
  const element = useRef<HTMLCanvasElement>(null);
  const [surface, setSurface] = useState<GlSurface | null>(null);
  const newest = useRef<GlSurface | null>(null);
  const [isRelief, setRelief] = useState(false);
  const [lost, setLost] = useState(0);

  useEffect(() => {
    const target = element.current;
    if (!target || isRelief) return;
    const made = GlSurface.on(target);
    if (!made) {
      setRelief(true);
      onMode("relief");
      return;
    }
    onMode("gl");
    setSurface(made);
    newest.current = made;
    const gone = (event: Event): void => event.preventDefault();
    const back = (): void => setLost((count) => count + 1);
    target.addEventListener("webglcontextlost", gone);
    target.addEventListener("webglcontextrestored", back);
    return () => {
      target.removeEventListener("webglcontextlost", gone);
      target.removeEventListener("webglcontextrestored", back);
      setSurface(null);
    };
  }, [isRelief, lost]);
  // Not before: a context that was lost and came back belongs to the same canvas.
  useEffect(() => () => newest.current?.end(), []);

  const mesh = ({ heights, colours }: Layer): Mesh => meshOf(heights, colours.mean, range, byTexture ? kGreyTable : kViridisTable, map, exaggeration);

  // At once, and what it draws within the same frame: a hand that turns it sees where it is.
  useLayoutEffect(() => {
    if (!surface) return;
    surface.loadMesh("coarse", mesh(coarse));
    surface.loadMesh("fine", mesh(fine));
    surface.load("frame", ...frameAt(map.width * map.pitch_x, map.height * map.pitch_y, heights_um.low, 128), true);
  }, [surface, coarse, fine, range.low, range.high, byTexture, exaggeration]);

  useLayoutEffect(() => {
    const target = element.current;
    if (!target || isRelief || !surface) return;
    const ratio = moving ? 1 : globalThis.devicePixelRatio || 1;
    const [width, height] = [Math.round(canvas.width * ratio), Math.round(canvas.height * ratio)];
    if (target.width !== width || target.height !== height) {
      target.width = width;
      target.height = height;
    }
    const half = Math.hypot(map.width * map.pitch_x, map.height * map.pitch_y) / 2;
    const matrix = matrixOf(look, half, (heights_um.low + heights_um.high) / 2, exaggeration, width / height);
    const draw = (): void => surface.draw([moving ? "coarse" : "fine", "frame"], matrix, width, height);
    const frame = requestAnimationFrame(draw);
    addEventListener("beforeprint", draw);  // what was drawn is not kept once it was shown
    return () => {
      cancelAnimationFrame(frame);
      removeEventListener("beforeprint", draw);
    };
  }, [surface, look, moving, coarse, fine, range.low, range.high, byTexture, exaggeration, canvas.width, canvas.height]);

  useEffect(() => {
    const context = isRelief && element.current?.getContext("2d");
    if (!context) return;
    const drawn = mesh(fine);
    context.canvas.width = drawn.columns;
    context.canvas.height = drawn.rows;
    context.putImageData(new ImageData(reliefPixels(drawn), drawn.columns, drawn.rows), 0, 0);
  }, [isRelief, fine, range.low, range.high, byTexture, exaggeration]);

  // A canvas that gave out a kind of context gives no other: the relief has one of its own.
  return html`<canvas key=${isRelief ? "relief" : "gl"} ref=${element} class=${isRelief ? "view3d-relief" : "view3d-canvas"} aria-hidden="true"></canvas>`;
}
