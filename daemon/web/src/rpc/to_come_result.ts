// Calls of the result page that the daemon does not describe yet. Until it does, the page does without them.
import { RpcError, call } from "./rpc.ts";

export interface ProfileReply {
  distance_um: number[];
  height_um: (number | null)[];
  sigma_um: (number | null)[];
}

const kUnknownMethod = -32601;

type AnyCall = (method: string, params: unknown, options?: { signal?: AbortSignal }) => Promise<unknown>;

let isMissing = false;

// Null: this daemon has no such call.
export async function askProfile(params: { job_id: string; from_um: { x: number; y: number }; to_um: { x: number; y: number }; width_um: number },
  signal: AbortSignal): Promise<ProfileReply | null> {
  if (isMissing) return null;
  try {
    return await (call as unknown as AnyCall)("result.profile", params, { signal }) as ProfileReply;
  } catch (error) {
    if (!(error instanceof RpcError) || error.code !== kUnknownMethod) throw error;
    isMissing = true;
    return null;
  }
}
