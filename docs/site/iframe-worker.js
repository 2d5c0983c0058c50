// Material searches in a worker, which browsers refuse to a page from disk: a hidden frame takes its
// place.
if (location.protocol === "file:") {
  const load = (frame, url) => new Promise((done, failed) => {
    const script = frame.document.createElement("script");
    script.src = url;
    script.onload = done;
    script.onerror = failed;
    frame.document.body.append(script);
  });
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      this.element = document.createElement("iframe");
      this.element.hidden = true;
      document.body.append(this.element);
      this.frame = this.element.contentWindow;
      this.frame.postMessage = data => this.dispatchEvent(new MessageEvent("message", {data}));
      this.frame.importScripts = async (...urls) => { for (const each of urls) await load(this.frame, each); };
      this.loaded = load(this.frame, url);
    }
    postMessage(data) {
      this.loaded.then(() => this.frame.dispatchEvent(new MessageEvent("message", {data})));
    }
    terminate() { this.element.remove(); }
  };
  window.IFrameWorker = window.Worker;  // Material asks for this name
}
