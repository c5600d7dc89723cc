// Dark or light: what the person chose last, or else what the desktop is.

const root = document.documentElement;
const button = document.getElementById("theme");

function show(theme) {
  root.dataset.theme = theme;
  button.textContent = theme === "light" ? "Dark" : "Light";
}

// Makes the button work; gives what it does, for a key. `redraw` is called after each change.
export function startTheme(redraw) {
  show(localStorage.getItem("trench.theme") ?? (matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark"));
  const change = () => {
    show(root.dataset.theme === "light" ? "dark" : "light");
    localStorage.setItem("trench.theme", root.dataset.theme);
    redraw();
  };
  button.addEventListener("click", change);
  return change;
}
