// The devices do one command at a time. The live picture takes its turn between the commands of this tab, so that
// a press is not answered with "busy" by the page's own picture.
import { createStore } from "../lib/store.ts";
import { asMotion, sincePress, tooLate } from "../rpc/stop_stage.ts";

let last: Promise<unknown> = Promise.resolve();

// How many commands of this tab run or wait: the live picture pauses meanwhile.
export const commandsUnderWay = createStore(0);

function inTurn<T>(work: () => Promise<T>): Promise<T> {
  const turn = last.then(work, work);
  last = turn.catch(() => undefined);
  return turn;
}

// What a stop came before, or what waited for very long, is not done any more: it may move the stage.
export async function asCommand<T>(work: () => Promise<T>): Promise<T> {
  const mayBegin = sincePress();
  commandsUnderWay.update((count) => count + 1);
  try {
    return await inTurn(() => {
      if (!mayBegin()) throw tooLate();
      return asMotion(work);
    });
  } finally {
    commandsUnderWay.update((count) => count - 1);
  }
}

export const asPicture = inTurn;
