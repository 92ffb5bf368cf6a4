// What to tell people of an error. The daemon's own messages say what happened and what to do.
import { t } from "../i18n/i18n.ts";
import { RpcError, kOffline } from "../rpc/rpc.ts";

export function messageOf(error: unknown): string {
  if (error instanceof RpcError) return error.code === kOffline ? t("error.offline") : error.message;
  return error instanceof Error ? error.message : String(error);
}
