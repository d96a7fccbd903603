// The front end: a report with its data inside, or with the engine a page that reads logs.
import { render } from "preact";
import "./app.css";
import { carriedDocument } from "./documents";
import { Report } from "./screens/report";
import { Shell } from "./ui/shell";

const place = document.getElementById("app");
const carried = carriedDocument();
if (place) {
  place.replaceChildren();
  render(carried ? <Report document={carried} /> : <Shell screens={[{ id: "report", name: "Report", show: () => <h1>FlightWatt</h1> }]} />, place);
}
