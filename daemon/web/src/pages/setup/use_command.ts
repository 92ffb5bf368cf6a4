// A command that a button sends: one at a time, with its answer or its error beside the button.
import { useState } from "preact/hooks";
import { messageOf } from "../../parts/message_of.ts";

export interface Command<T> {
  running: boolean;
  answer: T | null;
  problem: string;
  run: (work: () => Promise<T>) => Promise<T | null>;
}

export function useCommand<T>(): Command<T> {
  const [running, setRunning] = useState(false);
  const [answer, setAnswer] = useState<T | null>(null);
  const [problem, setProblem] = useState("");
  const run = async (work: () => Promise<T>): Promise<T | null> => {
    if (running) return null;
    setRunning(true);
    setProblem("");
    try {
      const value = await work();
      setAnswer(() => value);
      return value;
    } catch (error) {
      setAnswer(null);
      setProblem(messageOf(error));
      return null;
    } finally {
      setRunning(false);
    }
  };
  return { running, answer, problem, run };
}
