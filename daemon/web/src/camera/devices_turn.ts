// The devices do one command at a time. The live picture takes its turn between the commands of this tab, so that
// a press is not answered with "busy" by the page's own picture.
import { createStore } from "../lib/store.ts";

let last: Promise<unknown> = Promise.resolve();

// How many commands of this tab run or wait: the live picture pauses meanwhile.
export const commandsUnderWay = createStore(0);

function inTurn<T>(work: () => Promise<T>): Promise<T> {
  const turn = last.then(work, work);
  last = turn.catch(() => undefined);
  return turn;
}

export async function asCommand<T>(work: () => Promise<T>): Promise<T> {
  commandsUnderWay.update((count) => count + 1);
  try {
    return await inTurn(work);
  } finally {
    commandsUnderWay.update((count) => count - 1);
  }
}

export const asPicture = inTurn;
