// What the camera sees, as often as the devices have time for it; nothing moves for it.
import { useEffect, useRef, useState } from "preact/hooks";
import { asPicture, commandsUnderWay } from "../camera/devices_turn.ts";
import { type Picture, type PictureParams, awaitPicture, takePicture } from "../camera/picture_source.ts";
import { number, t, useLanguage } from "../i18n/i18n.ts";
import { html } from "../lib/html.ts";
import { pause } from "../lib/patience.ts";
import { useStore } from "../lib/store.ts";
import { topics } from "../live/live.ts";
import { RpcError } from "../rpc/rpc.ts";
import { mayAs, session } from "../rpc/session.ts";
import { messageOf } from "./message_of.ts";

const kPause_ms = 150;     // between pictures
const kAfterError_ms = 2000;

interface Shown extends Omit<Picture, "blob"> {
  address: string;
}

// Fetches pictures until the signal: shows each, and tells what hinders. params: null = this tab has none taken.
async function look(signal: AbortSignal, params: (() => PictureParams) | null, show: (picture: Picture) => void, tell: (problem: string) => void): Promise<void> {
  let after = 0;
  while (!signal.aborted) {
    let pause_ms = kPause_ms;
    const isFree = document.visibilityState === "visible" && (params === null || commandsUnderWay.get() === 0);
    if (isFree) {
      try {
        const picture = params === null
          ? await awaitPicture(after, signal)
          : await asPicture(() => takePicture(params(), signal));
        if (picture) {
          after = picture.seq;
          show(picture);
          tell("");
        }
      } catch (error) {
        if (signal.aborted) return;
        // Another command has the devices: the last picture stays, the next one comes when it is done.
        if (!(error instanceof RpcError && error.error === "busy")) {
          tell(messageOf(error));
          pause_ms = kAfterError_ms;
        }
      }
    }
    await pause(pause_ms, signal);
  }
}

interface Props {
  params: PictureParams;  // that pictures are taken with
  onPlace?: (z_um: number) => void;  // where the stage was at each
}

export function CameraPicture({ params, onPlace }: Props) {
  useLanguage();
  const newest = useRef({ params, onPlace });
  newest.current = { params, onPlace };
  const [on, setOn] = useState(true);
  const [shown, setShown] = useState<Shown | null>(null);
  const [problem, setProblem] = useState("");
  const takes = mayAs(useStore(session).role, "operate");
  // While the devices are being opened or lost there is no picture to ask for.
  const hasCamera = (useStore(topics).health?.camera as { open?: boolean } | undefined)?.open === true;
  const looks = on && hasCamera;

  useEffect(() => {
    if (!looks) return undefined;
    const abort = new AbortController();
    let address = "";
    void look(abort.signal, takes ? () => newest.current.params : null, ({ blob, ...about }) => {
      if (abort.signal.aborted) return;
      URL.revokeObjectURL(address);
      address = URL.createObjectURL(blob);
      if (about.z_um !== null) newest.current.onPlace?.(about.z_um);
      setShown({ ...about, address });
    }, setProblem);
    return () => {
      abort.abort();
      setShown(null);
      setProblem("");
      URL.revokeObjectURL(address);
    };
  }, [looks, takes]);

  const told = shown && [
    shown.z_um !== null && `z ${number(shown.z_um, 2)} µm`,
    shown.focus !== null && t("setup.picture.focus", { focus: number(shown.focus, 1) }),
    shown.saturated_fraction !== null && t("setup.picture.saturated", { percent: number(100 * shown.saturated_fraction, 2) }),
  ].filter(Boolean).join(" · ");
  return html`<section class="panel camera-picture" aria-labelledby="picture-title">
    <h2 id="picture-title">${t("setup.picture.title")}</h2>
    <label class="check"><input type="checkbox" checked=${on} onChange=${() => setOn(!on)}/> ${t("setup.picture.on")}</label>
    ${shown
      ? html`<figure><img src=${shown.address} alt=${t("setup.picture.alt")} width=${shown.width_px} height=${shown.height_px}/>
          <figcaption>${told}</figcaption></figure>`
      : html`<p class="help empty">${t(!hasCamera ? "setup.picture.no_camera" : !on ? "setup.picture.off" : "setup.picture.none")}</p>`}
    ${problem && html`<p class="problem" role="alert"><span aria-hidden="true">▲ </span>${problem}</p>`}
  </section>`;
}
