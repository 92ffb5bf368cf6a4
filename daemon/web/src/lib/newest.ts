// Asks after a pause, and gives on only the answer to what was asked last: an older one that comes late is not for anybody.
export function askNewest<Q, A>(
  ask: (question: Q, signal: AbortSignal) => Promise<A>,
  take: (answer: A, question: Q) => void,
  fail: (error: unknown, question: Q) => void,
  pause_ms: number,
): { ask: (question: Q) => void; end: () => void } {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let running: AbortController | null = null;
  const end = (): void => {
    clearTimeout(timer);
    running?.abort();
    running = null;
  };
  return {
    end,
    ask: (question) => {
      end();
      timer = setTimeout(() => {
        const mine = new AbortController();
        running = mine;
        ask(question, mine.signal).then(
          (answer) => { if (running === mine) take(answer, question); },
          (error) => { if (running === mine) fail(error, question); },
        );
      }, pause_ms);
    },
  };
}
