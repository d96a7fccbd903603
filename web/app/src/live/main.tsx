// The page of a flight in the air: it shows the events of its server, and changes nothing on the aircraft or in the program.
import { render } from "preact";
import "./live.css";
import { LiveFlight, type LiveState, type Point } from "./flight";
import { LivePage } from "./page";
import { type Kind, nameOf, statusOf } from "./words";

const place = document.getElementById("app") as HTMLElement;
const flight = new LiveFlight();
let shown: Kind | null = null;
let spoken = "";

function show() {
  const [kind, headline, action] = statusOf(flight);
  const is_over = flight.hasLanded();
  const is_urgent = kind === "alarm" || kind === "silent";
  document.body.className = [kind, flight.isOld() && !is_over && "old", is_over && "over"].filter(Boolean).join(" ");
  document.title = `${headline}${kind === "alarm" || kind === "caution" ? `: ${action}` : ""} – ${nameOf(flight.state)}`;
  if (kind !== shown) {
    spoken = `${headline}. ${action}`; // once, not every second
    if (is_urgent && navigator.userActivation?.hasBeenActive) navigator.vibrate?.([400, 150, 400]);
  }
  shown = kind;
  render(<LivePage flight={flight} spoken={spoken} />, place);
}

place.replaceChildren();
render(<LivePage flight={flight} spoken="" />, place); // a screen reader states changes alone
const events = new EventSource("events");
const on = <Content,>(name: string, take: (content: Content) => void) =>
  events.addEventListener(name, ({ data }) => {
    take(JSON.parse(data));
    show();
  });
on("begin", ({ points }: { points: Point[] }) => flight.begin(points));
on("state", (state: LiveState | null) => state && flight.take(state));
events.addEventListener("error", () => {
  flight.is_connected = false;
  show();
});
setInterval(show, 1000);
