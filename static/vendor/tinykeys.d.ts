export const tinykeys: (target: EventTarget, bindings: Record<string, (event: KeyboardEvent) => void>) => () => void;
