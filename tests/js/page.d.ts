// What browsers offer and TypeScript does not know yet, and what an inflated script brings.
interface Uint8ArrayConstructor {
  fromBase64?(text: string): Uint8Array<ArrayBuffer>;
}

interface PlotlyHost extends HTMLElement {
  data?: object[];
}

declare const Plotly: {
  react(host: HTMLElement, data: object[], layout: object, config: object): void;
  toImage(figure: object, options: object): Promise<string>;
};

interface Window {
  Plotly?: typeof Plotly;
}
