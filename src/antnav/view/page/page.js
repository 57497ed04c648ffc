// The page of `antnav view`: the view, and its connection to the server.
import { mount } from "./view.js";

const address = new URL("ws", location.href);
address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
address.search = location.search;

mount(document.getElementById("antnav"), {
  linkable: true,
  connect({ opened, heard, closed }) {
    const socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onopen = opened;
    socket.onmessage = (event) => heard(event.data);
    socket.onclose = (event) => closed(event.code);
    return { send: (data) => socket.readyState === WebSocket.OPEN && socket.send(data) };
  },
});
