// ESLint of all TypeScript and JavaScript of the repository. Paths are relative to its root: `npm run lint` starts there.
import js from "@eslint/js";
import globals from "globals";
import tseslint from "typescript-eslint";

const benches = ["web-viewer/tools/*.ts"]; // outside tsconfig.json, because three.js comes without types

export default tseslint.config(
  { ignores: ["**/node_modules/", "web-viewer/src/gen/"] },
  { linterOptions: { reportUnusedDisableDirectives: "error" } },
  js.configs.recommended,
  { rules: { eqeqeq: "error" } },
  {
    files: ["**/*.mjs"],
    languageOptions: { globals: globals.node },
  },
  {
    // Functions that a browser evaluates are among the code of Node.js.
    files: ["tests/**/*.mjs", "web-viewer/tools/bench_*.mjs"],
    languageOptions: { globals: { ...globals.browser, spherule: "readonly", axe: "readonly" } },
  },
  {
    files: ["web-viewer/**/*.ts"],
    extends: [tseslint.configs.strictTypeChecked],
    languageOptions: { parserOptions: { project: "tsconfig.json", tsconfigRootDir: import.meta.dirname } },
    rules: {
      "@typescript-eslint/no-floating-promises": [
        "error",
        { allowForKnownSafeCalls: [{ from: "package", name: ["test", "describe"], package: "node:test" }] },
      ],
      "@typescript-eslint/no-unused-vars": ["error", { argsIgnorePattern: "^_", varsIgnorePattern: "^_$" }],
      "@typescript-eslint/restrict-template-expressions": ["error", { allowNumber: true }],
      // Interfaces declare their functions as methods, also where no object calls them with `this`.
      "@typescript-eslint/unbound-method": "off",
      // Text is split into code points on purpose.
      "@typescript-eslint/no-misused-spread": ["error", { allow: ["string"] }],
      // Assertions of types and other choices of style:
      "@typescript-eslint/no-confusing-void-expression": "off",
      "@typescript-eslint/no-dynamic-delete": "off",
      "@typescript-eslint/no-unsafe-class-instance-assignment": "off",
      "@typescript-eslint/no-unsafe-enum-assignment": "off",
    },
  },
  {
    files: ["web-viewer/src/**/*.ts"],
    rules: { "@typescript-eslint/explicit-function-return-type": ["error", { allowExpressions: true }] },
  },
  {
    files: ["web-viewer/tests/**/*.ts"],
    rules: {
      "@typescript-eslint/no-non-null-assertion": "off",
      "@typescript-eslint/restrict-template-expressions": ["error", { allowNumber: true, allowArray: true }],
    },
  },
  { files: benches, extends: [tseslint.configs.disableTypeChecked] },
);
