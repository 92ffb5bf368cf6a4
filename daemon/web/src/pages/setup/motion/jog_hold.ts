// A jog lives only as long as it is repeated: this repeats it while a button is held, and then sends nothing more.
// The daemon ends a jog 150 ms after the last repeat, so that whatever becomes of this page, the stage halts.

export type Direction = "up" | "down";

export interface JogPort {
  send(direction: Direction, signal: AbortSignal): Promise<void>;
  isTransient(error: unknown): boolean;  // the devices are another command's for the moment
  ended(error: unknown): void;           // by an error; undefined = by the person
  setTimer(call: () => void, after_ms: number): unknown;
  clearTimer(timer: unknown): void;
  now_ms(): number;  // of a clock that goes on while this computer sleeps
}

export const kRepeat_ms = 100;
export const kUntil_ms = 150;
const kTryAgain_ms = 25;  // a picture may just be taken
const kLongest_ms = 1000;  // between two repeats

// One press, from the hand's coming to its going.
interface Press {
  direction: Direction;
  abort: AbortController;
  timer: unknown;
  last_ms: number;   // when it was repeated, or begun
  begun: boolean;
  waiting: boolean;  // for an answer
  due: boolean;      // a repeat was due while an answer was awaited
}

export class JogHold {
  #port: JogPort;
  #press: Press | null = null;

  constructor(port: JogPort) {
    this.#port = port;
  }

  get direction(): Direction | null {
    return this.#press?.direction ?? null;
  }

  begin(direction: Direction): void {
    this.end();
    this.#press = { direction, abort: new AbortController(), timer: null, last_ms: this.#port.now_ms(), begun: false, waiting: false, due: false };
    this.#repeat(this.#press);
  }

  // Sends nothing: silence is what ends a jog, and silence always gets through.
  end(error?: unknown): void {
    const press = this.#press;
    if (press === null) return;
    this.#press = null;
    this.#port.clearTimer(press.timer);
    // A repeat that waits in a queue would move the stage after the hand is off the button.
    press.abort.abort();
    this.#port.ended(error);
  }

  #repeat(press: Press): void {
    // After a sleep, or where the page stood still, nobody knows whether the hand is still there: the stage has halted, and
    // a repeat would be a new motion.
    const now_ms = this.#port.now_ms();
    if (now_ms - press.last_ms > kLongest_ms) {
      this.end();
      return;
    }
    press.last_ms = now_ms;
    this.#again(press, kRepeat_ms);
    // Never two under way: on a slow line they would pile up, and arrive when nobody holds the button.
    press.due = press.waiting;
    if (press.waiting) return;
    press.waiting = true;
    this.#port.send(press.direction, press.abort.signal).then(
      () => this.#answered(press),
      (error: unknown) => this.#refused(press, error),
    );
  }

  #answered(press: Press): void {
    press.waiting = false;
    press.begun = true;
    if (press === this.#press && press.due) this.#repeat(press);
  }

  #refused(press: Press, error: unknown): void {
    press.waiting = false;
    if (press !== this.#press) return;
    if (press.begun || !this.#port.isTransient(error)) this.end(error);
    else this.#again(press, kTryAgain_ms);
  }

  #again(press: Press, after_ms: number): void {
    this.#port.clearTimer(press.timer);
    press.timer = this.#port.setTimer(() => this.#repeat(press), after_ms);
  }
}
