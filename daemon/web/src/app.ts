// The page's frame, and which page is in it.
import { useEffect } from "preact/hooks";
import { type TextKey, t, useLanguage } from "./i18n/i18n.ts";
import { html } from "./lib/html.ts";
import { later } from "./lib/later.ts";
import { match, place } from "./lib/router.ts";
import { useStore } from "./lib/store.ts";
import { RunPage } from "./pages/run/run_page.ts";
import { TopBar } from "./parts/top_bar.ts";

// The run page is what an operator opens; the others are fetched when somebody goes there.
const more = () => import("./pages/more_pages.ts");
const HistoryPage = later(() => more().then((all) => all.HistoryPage));
const RecipeListPage = later(() => more().then((all) => all.RecipeListPage));
const RecipePage = later(() => more().then((all) => all.RecipePage));
const ResultPage = later(() => more().then((all) => all.ResultPage));
const SetupPage = later(() => more().then((all) => all.SetupPage));

// The browser's name for the page: tabs, history and screen readers tell pages apart by it.
function titleOf(path: string): string {
  const first = `/${path.split("/")[1] ?? ""}`;
  const titles: Record<string, TextKey> = { "/": "nav.run", "/jobs": "nav.history", "/recipes": "nav.recipes", "/setup": "nav.setup" };
  const key = titles[first];
  return key ? `${t(key)} – ${t("app.title")}` : t("app.title");
}

function Content() {
  const { path } = useStore(place);
  if (path === "/") return html`<${RunPage}/>`;
  if (path === "/jobs") return html`<${HistoryPage}/>`;
  if (path === "/recipes") return html`<${RecipeListPage}/>`;
  if (path === "/setup") return html`<${SetupPage}/>`;
  const job = match("/jobs/:id", path);
  if (job?.["id"]) return html`<${ResultPage} key=${job["id"]} id=${job["id"]}/>`;
  const recipe = match("/recipes/:id", path);
  if (recipe?.["id"]) return html`<${RecipePage} key=${recipe["id"]} id=${recipe["id"]}/>`;
  return html`<h1>${t("page.missing")}</h1><p><a href="/">${t("page.back")}</a></p>`;
}

export function App() {
  const language = useLanguage();
  const { path } = useStore(place);
  useEffect(() => {
    document.title = titleOf(path);
  }, [path, language]);
  return html`<${TopBar}/>
    <main id="main" tabindex="-1"><${Content}/></main>`;
}
