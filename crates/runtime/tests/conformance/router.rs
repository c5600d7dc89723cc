//! Islands whose processes speak Zenoh.

use crate::common::Island;

impl Island {
    /// An island whose processes speak Zenoh, through a router of its own.
    pub(crate) fn with_router(number: u16) -> Self {
        Self::with_router_of(number, "")
    }

    /// The same with further assignments to the router's configuration.
    pub(crate) fn with_router_of(number: u16, overrides: &str) -> Self {
        let mut island = Self::new(number);
        let mut command = island.command("router", "");
        command.env("ZENOH_CONFIG_OVERRIDE", format!("listen/endpoints=[\"tcp/127.0.0.1:0\"];{overrides}"));
        let router = Self::run(command);
        let locator = router.line();
        island.router = Some((router, locator));
        island
    }
}
