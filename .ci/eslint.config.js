// Rules for the page's own modules; what is vendored is left as it came.
import js from "@eslint/js";

const BROWSER = [
  "AbortController", "Blob", "DOMException", "DOMMatrix", "DOMPoint", "DataView", "Element", "FileReader", "FormData", "HTMLElement", "IntersectionObserver", "MutationObserver", "Option",
  "Path2D", "ResizeObserver", "URL", "URLSearchParams", "WebSocket", "XMLHttpRequest", "addEventListener",
  "cancelAnimationFrame", "clearTimeout", "console", "devicePixelRatio", "document", "fetch", "getComputedStyle",
  "history", "innerHeight", "innerWidth", "localStorage", "location", "matchMedia", "navigator", "performance", "queueMicrotask",
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
      complexity: ["error", 18],
      curly: ["error", "multi-line"],
      eqeqeq: "error",
      "max-lines": ["error", { max: 320 }],
      "no-console": "error",
      "no-implicit-globals": "error",
      "no-shadow": "error",
      "no-unused-vars": ["error", { args: "after-used", argsIgnorePattern: "^_" }],
      "no-var": "error",
      "object-shorthand": "error",
      "prefer-const": "error",
      "prefer-template": "error",
    },
  },
];
