import { render } from "preact";
import { App } from "./app.ts";
import { loadTexts } from "./i18n/i18n.ts";
import { html } from "./lib/html.ts";
import { followLinks } from "./lib/router.ts";
import { applyTheme } from "./lib/theme.ts";
import { rememberHealth } from "./live/health_history.ts";
import { watchLeaving } from "./lib/visit.ts";
import { link, listen } from "./live/live.ts";
import { watchControl } from "./rpc/held_control.ts";
import { lookWhoIAm, watchRefusals } from "./rpc/session.ts";
import { takeTokenFromAddress, watchAddress } from "./rpc/token_in_address.ts";
import "./style/main.css";

takeTokenFromAddress();
applyTheme();
followLinks();
watchLeaving();
listen();
rememberHealth();
watchControl();
watchAddress();
watchRefusals();
// Again after every reconnection: the daemon may have another file of tokens.
const know = (): void => void lookWhoIAm().catch(() => undefined);
let was = link.get().status;
link.watch(() => {
  const { status } = link.get();
  if (status === "open" && was === "lost") know();
  was = status;
});
know();
const page = document.getElementById("page");
// Without its texts the page says nothing: then it is asked for again, as a whole.
loadTexts().then(() => {
  if (page) render(html`<${App}/>`, page);
}, () => setTimeout(() => location.reload(), 3000));
