// What the camera sees: with what is sharp, what is too bright, and the recipe's regions drawn in.
import { useEffect, useRef, useState } from "preact/hooks";
import { number, t, tWord, useLanguage } from "../../i18n/i18n.ts";
import { html } from "../../lib/html.ts";
import { useStore } from "../../lib/store.ts";
import { link, topics } from "../../live/live.ts";
import { framed } from "../../parts/framed.ts";
import { type Marks, paintMarks } from "../../run/focus_peaking.ts";
import { type Picture, type PreviewStatus, watchPreview } from "../../run/preview_poll.ts";
import { pitchOf, shapesOf } from "../../run/regions.ts";
import { RegionOverlay } from "./region_overlay.ts";
import { useRecipeId } from "./use_machine.ts";
import { useRecipe } from "./use_recipe.ts";

type Told = Omit<Picture, "bitmap">;

// A browser has six connections: state, values and map come first, and a picture may be that much later.
const kAfterFirstView_ms = 200;

function paint(canvas: HTMLCanvasElement, bitmap: ImageBitmap, marks: Marks): void {
  if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
    canvas.width = bitmap.width;
    canvas.height = bitmap.height;
  }
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (!context) return;
  context.drawImage(bitmap, 0, 0);
  if (!marks.focus && !marks.saturation) return;
  const image = context.getImageData(0, 0, bitmap.width, bitmap.height);
  paintMarks(image.data, bitmap.width, bitmap.height, marks);
  context.putImageData(image, 0, 0);
}

// The newest picture is kept, so that a change of the marks shows at once.
function usePreview(marks: Marks) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const newest = useRef<ImageBitmap | null>(null);
  const wanted = useRef(marks);
  const [told, setTold] = useState<Told | null>(null);
  const [status, setStatus] = useState<PreviewStatus>("waiting");
  const draw = (): void => {
    if (canvas.current && newest.current) paint(canvas.current, newest.current, wanted.current);
  };
  const isLinked = useStore(link).status !== "never";
  useEffect(() => {
    if (!isLinked) return;
    let end = (): void => undefined;
    const begin = setTimeout(() => {
      end = watchPreview(({ bitmap, ...rest }) => {
        newest.current?.close();
        newest.current = bitmap;
        setTold(rest);
        draw();
      }, setStatus);
    }, kAfterFirstView_ms);
    return () => {
      clearTimeout(begin);
      end();
      newest.current?.close();
    };
  }, [isLinked]);
  useEffect(() => {
    wanted.current = marks;
    draw();
  }, [marks.focus, marks.saturation]);
  return { canvas, told, status };
}

function Check({ label, value, set }: { label: string; value: boolean; set: (value: boolean) => void }) {
  return html`<label class="check"><input type="checkbox" checked=${value}
    onChange=${(event: Event) => set((event.target as HTMLInputElement).checked)}/> ${label}</label>`;
}

export function LivePicture() {
  useLanguage();
  const [focus, setFocus] = useState(true);
  const [saturation, setSaturation] = useState(true);
  const [regions, setRegions] = useState(true);
  const { canvas, told, status } = usePreview({ focus, saturation });
  const { job } = useStore(topics);
  const chosen = useRecipeId();
  const recipe = useRecipe(job && !job.done ? job.recipe : chosen);
  const { shapes, notDrawn } = shapesOf(recipe);
  const pitch = pitchOf(recipe) ?? { x: 1, y: 1 };
  const isOld = status !== "picture";
  // The first answer may take ten seconds where nothing takes pictures.
  const says = status === "waiting" && (!job || job.done) ? "none" : status;
  return html`<section class="panel live" aria-labelledby="live-title">
    <h2 id="live-title">${t("run.live")}</h2>
    <div class=${`picture ${isOld ? "old" : ""}`} style=${told ? framed(told.width_px * pitch.x, told.height_px * pitch.y) : undefined}>
      <canvas ref=${canvas} role="img" aria-label=${told ? t("run.live_alt") : t("run.live_none")} hidden=${told === null}></canvas>
      ${told && regions && html`<${RegionOverlay} shapes=${shapes} width_um=${told.width_px * pitch.x} height_um=${told.height_px * pitch.y}/>`}
      ${isOld && html`<p class="picture-says">${tWord("run.live_status", says)}</p>`}
    </div>
    <p class="help figures-line">${told && html`
      <span>z ${number(told.z_um, 1)} µm</span> <span>${t("run.live_focus", { focus: number(told.focus, 1) })}</span>
      <span class=${told.saturated_fraction > 0.001 ? "problem" : undefined}>${t("run.live_saturated", { share: number(100 * told.saturated_fraction, 2) })}</span>`}</p>
    <div class="checks">
      <${Check} label=${html`<span class="swatch swatch-focus"></span> ${t("run.mark_focus")}`} value=${focus} set=${setFocus}/>
      <${Check} label=${html`<span class="swatch swatch-saturated"></span> ${t("run.mark_saturated")}`} value=${saturation} set=${setSaturation}/>
      <${Check} label=${t("run.mark_regions")} value=${regions} set=${setRegions}/>
    </div>
    ${regions && notDrawn.length > 0 && html`<p class="help">${t("run.not_drawn", { names: notDrawn.join(", ") })}</p>`}
  </section>`;
}
