// A study by its name, for its parameters are filled into a form made of the daemon's description.
import { call } from "../../../rpc/rpc.ts";
import type { StudyReply } from "./study_types.ts";

type AnyCall = (method: string, params: Record<string, unknown>) => Promise<unknown>;

export async function runStudy(method: string, params: Record<string, unknown>): Promise<StudyReply> {
  return (await (call as unknown as AnyCall)(method, params)) as StudyReply;
}
