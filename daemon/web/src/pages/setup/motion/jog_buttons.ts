// Two buttons that move the stage while they are held, by a pointer or by a key.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { commandsUnderWay } from "../../../camera/devices_turn.ts";
import { t, useLanguage } from "../../../i18n/i18n.ts";
import { html } from "../../../lib/html.ts";
import { readNumber } from "../../../lib/read_number.ts";
import { place } from "../../../lib/router.ts";
import { moment } from "../../../lib/wake.ts";
import { messageOf } from "../../../parts/message_of.ts";
import { RpcError, call } from "../../../rpc/rpc.ts";
import { useRefusal } from "../permission.ts";
import { Problem } from "../problem.ts";
import { type Direction, JogHold, kUntil_ms } from "./jog_hold.ts";
import { stagePlace } from "./stage_place.ts";

const kHoldKeys = new Set([" ", "Enter"]);
const kSpeeds_um_per_s = [5, 20, 100, 500];

function isTransient(error: unknown): boolean {
  return error instanceof RpcError && error.error === "busy";
}

// What ends every jog, whatever is under the finger: the page is no longer in front, or no longer this one.
function endsWith(hold: JogHold): () => void {
  const end = (): void => hold.end();
  const hidden = (): void => {
    if (document.visibilityState !== "visible") hold.end();
  };
  addEventListener("blur", end);
  addEventListener("pagehide", end);
  document.addEventListener("visibilitychange", hidden);
  const unwatch = place.watch(end);
  return () => {
    hold.end();
    removeEventListener("blur", end);
    removeEventListener("pagehide", end);
    document.removeEventListener("visibilitychange", hidden);
    unwatch();
  };
}

export function JogButtons() {
  useLanguage();
  const [speed, setSpeed] = useState("20");
  const [held, setHeld] = useState<Direction | null>(null);
  const [problem, setProblem] = useState("");
  const why = useRefusal({ role: "set_up", control: true, still: true });
  const value = readNumber(speed);
  const isSpeed = value !== null && value > 0;
  const speedNow = useRef(0);
  speedNow.current = isSpeed ? value : 0;

  const hold = useMemo(() => new JogHold({
    send: async (direction, signal) => {
      await call("stage.jog", { direction, speed_um_per_s: speedNow.current, until_ms: kUntil_ms }, { signal });
    },
    isTransient,
    ended: (error) => {
      setHeld(null);
      commandsUnderWay.update((count) => count - 1);
      if (error !== undefined) setProblem(messageOf(error));
    },
    setTimer: (work, after_ms) => setTimeout(work, after_ms),
    clearTimer: (timer) => clearTimeout(timer as number),
    now_ms: () => moment().clock_ms,
  }), []);
  useEffect(() => endsWith(hold), [hold]);
  // Control taken away, a job begun, no such speed: what may not be begun may not go on.
  const may = why === "" && isSpeed;
  useEffect(() => {
    if (!may) hold.end();
  }, [may, hold]);

  const begin = (direction: Direction): void => {
    if (!may || hold.direction !== null) return;
    setProblem("");
    setHeld(direction);
    commandsUnderWay.update((count) => count + 1);
    stagePlace.set(null);  // the next picture or command tells it
    hold.begin(direction);
  };
  const end = (): void => hold.end();
  const button = (direction: Direction) => html`<button type="button" class=${`main jog ${held === direction ? "held" : ""}`}
    disabled=${!may} aria-describedby="jog-help"
    onPointerDown=${(event: PointerEvent) => {
      if (event.button !== 0) return;
      (event.currentTarget as Element).setPointerCapture(event.pointerId);
      begin(direction);
    }}
    onPointerUp=${end} onPointerCancel=${end} onLostPointerCapture=${end}
    onKeyDown=${(event: KeyboardEvent) => {
      if (!kHoldKeys.has(event.key)) return;
      event.preventDefault();
      if (!event.repeat) begin(direction);
    }}
    onKeyUp=${(event: KeyboardEvent) => {
      if (kHoldKeys.has(event.key)) end();
    }}
    onBlur=${end} onContextMenu=${(event: Event) => event.preventDefault()}>
    <span aria-hidden="true">${direction === "up" ? "▲" : "▼"}</span> ${t(direction === "up" ? "setup.jog.up" : "setup.jog.down")}
  </button>`;

  return html`<section class="panel" aria-labelledby="jog-title">
    <h2 id="jog-title">${t("setup.jog.title")}</h2>
    <label class="field">${t("setup.jog.speed")}
      <input class="short" inputmode="decimal" value=${speed} list="jog-speeds" aria-invalid=${!isSpeed}
        onInput=${(event: Event) => setSpeed((event.target as HTMLInputElement).value)}/>
      <datalist id="jog-speeds">${kSpeeds_um_per_s.map((each) => html`<option value=${each}/>`)}</datalist>
    </label>
    <p class="buttons">${button("up")} ${button("down")}</p>
    <p id="jog-help" class="help">${why || t("setup.jog.help")}</p>
    ${!isSpeed && html`<${Problem} text=${t("setup.number_above_0")}/>`}
    <${Problem} text=${problem}/>
  </section>`;
}
