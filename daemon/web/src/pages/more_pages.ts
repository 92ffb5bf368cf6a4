// The pages that an operator does not open first: one script, fetched when somebody goes to any of them.
export { HistoryPage } from "./history/history_page.ts";
export { RecipeListPage } from "./recipe/recipe_list_page.ts";
export { RecipePage } from "./recipe/recipe_page.ts";
export { ResultPage } from "./result/result_page.ts";
export { SetupPage } from "./setup/setup_page.ts";
