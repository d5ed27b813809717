const line = new WebSocket("ws://127.0.0.1:8765");
const ask = (request) => new Promise((done) => {
  line.addEventListener("message", (event) => done(JSON.parse(event.data)), { once: true });
  line.send(JSON.stringify(request));
});
line.onopen = async () => {
  console.log(await ask({ do: "gesture", tags: ["greeting"] }));
  console.log(await ask({ do: "nod", in: 2 }));
  line.close();
};
