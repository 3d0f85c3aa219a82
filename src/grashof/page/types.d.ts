// Globals of the page scripts.

interface Window {
  grashof: Readonly<{ state: () => any }>;
  startLive: (root: HTMLElement, token: any, link?: string) => any;
}

/** Every event here comes from an element. */
interface EventTarget {
  closest(selector: string): any;
}

/** The whole page, before the widget's module. */
declare const PAGE: string;
