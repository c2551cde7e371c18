// Search without a server. A browser neither fetches files nor starts workers for a page that was opened from disk (file://): the index comes
// as a script (assets/search_index.js), and the worker of the theme runs in a hidden frame.
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      this.waiting = [];
      const frame = document.createElement("iframe");
      frame.hidden = true;
      document.body.appendChild(frame);
      window.addEventListener("message", event => {
        if (event.source === frame.contentWindow) this.dispatchEvent(new MessageEvent("message", {data: event.data}));
      });
      const inner = frame.contentDocument;
      inner.open();
      inner.write("<script>window.postMessage = data => parent.postMessage(data, '*');" +
                  "window.importScripts = () => {};<\/script><script src='" + new URL(url, location) + "'><\/script>");
      inner.close();
      frame.contentWindow.addEventListener("load", () => {
        this.frame = frame;
        for (const data of this.waiting) this.send(data);
      });
    }
    send(data) {
      this.frame.contentWindow.dispatchEvent(new MessageEvent("message", {data, source: window}));
    }
    postMessage(data) {
      if (this.frame) this.send(data);
      else this.waiting.push(data);
    }
    terminate() {}
  };
  var __search = {
    index: new Promise(resolve => {
      const script = document.createElement("script");
      script.src = uplift_base + "/assets/search_index.js";
      script.onload = () => resolve(uplift_search_index);
      document.head.appendChild(script);
    })
  };
}
