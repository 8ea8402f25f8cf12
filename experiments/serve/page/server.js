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

// Stops what this page has running.
export const leave = () => { post("leave", {}, {keepalive: true}).catch(() => {}); };
