// The places of a plan or an area, to be drawn on a map. What is flown of them, the program says.
import type { Place } from "../ui/map";

export interface PlanShape {
  lines: Place[][];
  areas: Place[][];
  home?: Place;
  /// Places with a name that no line joins.
  named: { name: string; place: Place }[];
}

const isPlace = (place: Place) => place.every(Number.isFinite) && !(place[0] === 0 && place[1] === 0);

type Json = { [key: string]: unknown };

function ofGeoJson(value: unknown, shape: PlanShape) {
  const object = value as Json;
  for (const inner of [
    ...((object.features as unknown[]) ?? []),
    ...(object.geometry ? [object.geometry] : []),
  ]) ofGeoJson(inner, shape);
  const places = (list: unknown) => (list as number[][]).map(([longitude, latitude]): Place => [
    latitude ?? NaN,
    longitude ?? NaN,
  ]);
  if (object.type === "Polygon") shape.areas.push(places((object.coordinates as unknown[])[0]));
  if (object.type === "MultiPolygon")
    for (const polygon of object.coordinates as unknown[][]) shape.areas.push(places(polygon[0]));
  if (object.type === "LineString") shape.lines.push(places(object.coordinates));
}

function ofPlan(plan: Json, shape: PlanShape) {
  const mission = (plan.mission ?? {}) as Json;
  const home = mission.plannedHomePosition as number[] | undefined;
  if (home) shape.home = [home[0] ?? NaN, home[1] ?? NaN];
  const line: Place[] = [];
  for (const item of (mission.items ?? []) as Json[]) {
    const polygon =
      (item.polygon ?? (item.TransectStyleComplexItem as Json | undefined)?.polygon) as Place[] | undefined;
    if (polygon) shape.areas.push(polygon);
    const inside = ((item.TransectStyleComplexItem as Json | undefined)?.Items ?? [item]) as Json[];
    for (const one of inside) {
      const params = one.params as number[] | undefined;
      const place: Place = [params?.[4] ?? NaN, params?.[5] ?? NaN];
      if (params && isPlace(place)) line.push(place);
    }
  }
  if (line.length > 0) shape.lines.push(line);
}

function ofWaypoints(text: string, shape: PlanShape) {
  const rows = text.split("\n").slice(1).map((line) => line.trim().split(/\s+/).map(Number));
  const places = rows.map((row): Place => [row[8] ?? NaN, row[9] ?? NaN]);
  if (places[0] && isPlace(places[0])) shape.home = places[0];
  shape.lines.push(places.filter(isPlace));
}

const metres_a_degree = 111_320;

/// Waypoints of Paparazzi: latitude and longitude, or metres from the plan's origin.
function ofFlightPlan(page: Document, shape: PlanShape) {
  const degrees = (text: string | null) => Number((text ?? "").replace(
    /^([NESW])(.*)$/,
    (_, side, rest) => (/[SW]/.test(side) ? `-${rest}` : rest),
  ));
  const plan = page.querySelector("flight_plan");
  const [latitude, longitude] = [
    degrees(plan?.getAttribute("lat0") ?? null),
    degrees(plan?.getAttribute("lon0") ?? null),
  ];
  for (const point of page.querySelectorAll("waypoints > waypoint")) {
    const at = (name: string) => Number(point.getAttribute(name));
    const place: Place = point.hasAttribute("lat")
      ? [degrees(point.getAttribute("lat")), degrees(point.getAttribute("lon"))]
      : [
        latitude + at("y") / metres_a_degree,
        longitude + at("x") / (metres_a_degree * Math.cos((latitude * Math.PI) / 180)),
      ];
    if (isPlace(place)) shape.named.push({ name: point.getAttribute("name") ?? "", place });
  }
}

function ofXml(text: string, shape: PlanShape) {
  const page = new DOMParser().parseFromString(text, "text/xml");
  ofFlightPlan(page, shape);
  for (const element of page.querySelectorAll("Polygon outerBoundaryIs coordinates, LineString coordinates")) {
    const places = (element.textContent ?? "").trim().split(/\s+/).map((one): Place => {
      const [longitude, latitude] = one.split(",").map(Number);
      return [latitude ?? NaN, longitude ?? NaN];
    });
    (element.closest("Polygon") ? shape.areas : shape.lines).push(places.filter(isPlace));
  }
}

/// Returns the places of a file; none where it has none that can be drawn.
export function shapeOf(path: string, text: string): PlanShape {
  const shape: PlanShape = { lines: [], areas: [], named: [] };
  try {
    if (/\.geojson$/i.test(path)) ofGeoJson(JSON.parse(text), shape);
    else if (/\.plan$/i.test(path)) ofPlan(JSON.parse(text) as Json, shape);
    else if (/\.waypoints$/i.test(path)) ofWaypoints(text, shape);
    else ofXml(text, shape);
  } catch {
    // The program says what is wrong with the file.
  }
  return shape;
}

/// Returns an area as a file.
export function areaFile(places: Place[]): string {
  const ring = [...places, ...places.slice(0, 1)].map(([latitude, longitude]) => [longitude, latitude]);
  return JSON.stringify({ type: "Feature", properties: {}, geometry: { type: "Polygon", coordinates: [ring] } });
}
