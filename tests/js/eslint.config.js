// Rules for the scripts of the pages, which are concatenated into one script a page, and for their
// tests. Which names there are is TypeScript's to check: it knows which scripts stand in a page.
import js from "@eslint/js";
import globals from "globals";

const RULES = {
  ...js.configs.recommended.rules,
  "array-callback-return": "error",
  "consistent-return": "error",
  "eqeqeq": "error",
  "max-len": ["error", { code: 120 }],
  "no-eval": "error",
  "no-implied-eval": "error",
  "no-self-compare": "error",
  "no-shadow": "error",
  "no-throw-literal": "error",
  "no-unused-expressions": "error",
  "no-useless-return": "error",
  "no-var": "error",
  "object-shorthand": "error",
  "prefer-const": "error",
};

export default [
  {
    files: ["reports/static/**/*.js"],
    languageOptions: { ecmaVersion: 2024, sourceType: "script", globals: globals.browser },
    rules: { ...RULES, "no-undef": "off", "no-unused-vars": ["error", { vars: "local" }] },
  },
  {
    files: ["tests/js/*.js"],
    languageOptions: { ecmaVersion: 2024, sourceType: "module", globals: globals.node },
    rules: RULES,
  },
];
