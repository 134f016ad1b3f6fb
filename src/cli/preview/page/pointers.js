
// What the mouse and fingers do: one turns the view, two move it and come nearer; a click looks at a pixel.

// Where each pressed pointer is, by its number.
const pressed = new Map();
// The way of all pointers since the first was pressed, in pixels of the screen.
let far = 0;

const STILL = 4;

function onDown(event) {
  if (pressed.size === 0) far = 0;
  pressed.set(event.pointerId, [event.clientX, event.clientY]);
  at("picture").setPointerCapture(event.pointerId);
}

function onMove(event) {
  if (!pressed.has(event.pointerId) || gaze === null) return;
  const before = [...pressed.values()];
  const [x, y] = pressed.get(event.pointerId);
  far += Math.abs(event.clientX - x) + Math.abs(event.clientY - y);
  pressed.set(event.pointerId, [event.clientX, event.clientY]);
  if (far < STILL) return;
  const { width, height } = at("picture").getBoundingClientRect();
  const [from, to] = [middle(before), middle([...pressed.values()])];
  const [right, above] = [(to.x - from.x) / width, (from.y - to.y) / height];
  if (pressed.size > 1) move(zoomed(panned(gaze, -right, -above), from.spread / to.spread));
  else if (event.shiftKey || event.buttons > 1) move(panned(gaze, -right, -above));
  else move(orbited(gaze, state.view.axis, -right * Math.PI, -above * Math.PI));
}

// The middle of points, and their mean distance from it.
function middle(points) {
  const mean = (axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length;
  const [x, y] = [mean(0), mean(1)];
  const spread = points.reduce((sum, point) => sum + Math.hypot(point[0] - x, point[1] - y), 0) / points.length;
  return { x, y, spread: Math.max(spread, 1) };
}

function onUp(event) {
  const isClick = pressed.size === 1 && far < STILL;
  if (!pressed.delete(event.pointerId) || !isClick || !state?.picture) return;
  const box = at("picture").getBoundingClientRect();
  const [width, height] = state.picture.full;
  at("x").value = Math.min(width - 1, Math.floor(((event.clientX - box.left) / box.width) * width));
  at("y").value = Math.min(height - 1, Math.floor(((event.clientY - box.top) / box.height) * height));
  inspect();
}

function listenToPointers(picture) {
  picture.addEventListener("pointerdown", onDown);
  picture.addEventListener("pointermove", onMove);
  picture.addEventListener("pointerup", onUp);
  picture.addEventListener("pointercancel", (event) => pressed.delete(event.pointerId));
  picture.addEventListener("contextmenu", (event) => event.preventDefault());
}
