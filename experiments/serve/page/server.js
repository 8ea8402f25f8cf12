// Questions to the server. The token comes in the address once, and is kept for this tab.
import {decode} from "./pictures.js";

export const client = [...crypto.getRandomValues(new Uint8Array(8))].map(b => b.toString(16).padStart(2, "0")).join("");

const inAddress = /[#&]token=([0-9a-zA-Z_-]+)/.exec(location.hash);
if (inAddress) {
  sessionStorage.setItem("airlight-token", inAddress[1]);
  history.replaceState(null, "", location.pathname + location.hash.replace(/[#&]token=[^&]*/, ""));
}

async function post(question, body, more = {}) {
  const headers = {"Content-Type": "application/json"}, token = sessionStorage.getItem("airlight-token");
  if (token) headers["X-Airlight-Token"] = token;
  const answer = await fetch(`api/${question}`, {method: "POST", headers, body: JSON.stringify({client, ...body}), ...more});
  if (!answer.ok) throw new Error((await answer.text()).trim());
  return answer;
}

export const ask = async (question, body) => (await post(question, body)).json();
export const askText = async (question, body) => (await post(question, body)).text();
export const askPicture = async (question, body) => decode(await (await post(question, body)).arrayBuffer());

// For as long as the page is seen, a connection stays open: when it ends, the server stops what this page has running. `again` is called
// when the page is seen again.
export async function watch(again) {
  for (let first = true;; first = false) {
    const hidden = new AbortController(), hide = () => { if (document.hidden) hidden.abort(); };
    document.addEventListener("visibilitychange", hide);
    try {
      const reader = (await post("watch", {}, {signal: hidden.signal})).body.getReader();
      if (!first) again();
      while (!(await reader.read()).done);
    } catch (error) {
      if (!(error instanceof TypeError) && error.name !== "AbortError") return;  // refused, as every other request will be
    }
    document.removeEventListener("visibilitychange", hide);
    if (document.hidden) await new Promise(done => document.addEventListener("visibilitychange", done, {once: true}));
    else await new Promise(done => setTimeout(done, 1000));
  }
}

// Stops what this page has running.
export const leave = () => { post("leave", {}, {keepalive: true}).catch(() => {}); };
