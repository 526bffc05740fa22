// Points at the middle of a panel of the first figure, drags, turns the wheel and goes back; says what came of it at the end of the page.
window.addEventListener("load", () => {
  const log = [];
  try {
    const figure = document.querySelector("figure"), svg = figure.querySelector("svg"), value = figure.querySelector(".value");
    const { left, top, width, height } = JSON.parse(figure.querySelector("script").textContent)[PANEL].frame;
    const group = svg.querySelectorAll(".panel")[PANEL];
    const drawn = () => [...group.querySelectorAll("[data-series]")].map(it => it.getAttribute("d")).join() + group.querySelector(".ticks").innerHTML;
    const at = (x, y) => new DOMPoint(left + x * width, top + y * height).matrixTransform(svg.getScreenCTM());
    const send = (target, type, { x, y }) =>
      target.dispatchEvent(new PointerEvent(type, { clientX: x, clientY: y, bubbles: true, button: 0, pointerType: "mouse" }));
    const before = drawn();
    // Somewhere near the middle there is a point.
    for (let i = 0; i < 60 && value.style.display !== "block"; i++) send(svg, "pointermove", at(0.5, i / 60));
    log.push("shown: " + value.style.display, value.innerText);
    send(svg, "pointerdown", at(0.2, 0.2));
    send(svg, "pointermove", at(0.7, 0.8));
    send(window, "pointerup", at(0.7, 0.8));
    const enlarged = drawn();
    log.push("enlarged: " + (enlarged !== before && figure.classList.contains("zoomed")));
    const { x, y } = at(0.5, 0.5);
    svg.dispatchEvent(new WheelEvent("wheel", { clientX: x, clientY: y, deltaY: -1, ctrlKey: true, bubbles: true, cancelable: true }));
    log.push("wheel: " + (drawn() !== enlarged));
    figure.querySelector(".reset").click();
    log.push("back: " + (drawn() === before && !figure.classList.contains("zoomed")));
  } catch (error) {
    log.push("failed: " + error);
  }
  const said = document.createElement("pre");
  said.id = "log";
  said.textContent = log.join("\n");
  document.body.append(said);
});
