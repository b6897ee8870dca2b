// Rules for the page's own modules; what is vendored is left as it came.
import js from "@eslint/js";

const BROWSER = [
  "AbortController", "Blob", "DataView", "FileReader", "FormData", "HTMLElement", "IntersectionObserver", "Option",
  "Path2D", "ResizeObserver", "URL", "URLSearchParams", "WebSocket", "XMLHttpRequest", "addEventListener",
  "cancelAnimationFrame", "clearTimeout", "console", "devicePixelRatio", "document", "fetch", "getComputedStyle",
  "history", "localStorage", "location", "matchMedia", "navigator", "performance", "queueMicrotask",
  "requestAnimationFrame", "requestIdleCallback", "setTimeout", "structuredClone", "window",
];

export default [
  js.configs.recommended,
  {
    files: ["**/*.js"],
    languageOptions: {
      ecmaVersion: 2024,
      sourceType: "module",
      globals: Object.fromEntries(BROWSER.map((name) => [name, "readonly"])),
    },
    rules: {
      complexity: ["error", 12],
      curly: ["error", "multi-line"],
      eqeqeq: "error",
      "max-lines": ["error", { max: 320 }],
      "no-console": "error",
      "no-implicit-globals": "error",
      "no-shadow": "error",
      "no-unused-vars": ["error", { args: "after-used" }],
      "no-var": "error",
      "object-shorthand": "error",
      "prefer-const": "error",
      "prefer-template": "error",
    },
  },
];
