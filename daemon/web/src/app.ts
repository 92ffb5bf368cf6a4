// The page's frame, and which page is in it.
import { t, useLanguage } from "./i18n/i18n.ts";
import { html } from "./lib/html.ts";
import { match, place } from "./lib/router.ts";
import { useStore } from "./lib/store.ts";
import { HistoryPage } from "./pages/history/history_page.ts";
import { RecipeListPage } from "./pages/recipe/recipe_list_page.ts";
import { RecipePage } from "./pages/recipe/recipe_page.ts";
import { ResultPage } from "./pages/result/result_page.ts";
import { RunPage } from "./pages/run/run_page.ts";
import { SetupPage } from "./pages/setup/setup_page.ts";
import { TopBar } from "./parts/top_bar.ts";

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
  return html`<p>${t("page.missing")} <a href="/">${t("page.back")}</a></p>`;
}

export function App() {
  useLanguage();
  return html`<${TopBar}/>
    <main id="main" tabindex="-1"><${Content}/></main>`;
}
