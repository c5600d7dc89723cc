//! What a core can have done.

use crate::RequestId;
use trench_msgs::Encode;

/// The importance of a log line, with rcl_interfaces/Log's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Level {
    /// For developers.
    Debug = 10,
    /// Normal events worth telling.
    Info = 20,
    /// Something is wrong, the node copes.
    Warn = 30,
    /// Something is wrong, and a function is lost.
    Error = 40,
    /// The node cannot go on.
    Fatal = 50,
}

/// Takes what a core wants done. Calls are carried out in order.
pub trait Sink {
    /// Publishes on `Interface::publications[port]`. The message is encoded once, into memory loaned by the transport.
    fn publish(&mut self, port: usize, message: &dyn Encode) {
        self.publish_with(port, message.encoded_len(), &mut |out| message.encode_into(out));
    }

    /// Publishes a message of at most `max_len` bytes that `fill` writes in place (CDR with its header) into memory
    /// loaned by the transport, giving its length. For large messages that are made where they are sent: images.
    fn publish_with(&mut self, port: usize, max_len: usize, fill: &mut dyn FnMut(&mut [u8]) -> usize);

    /// Answers a request.
    fn respond(&mut self, service: usize, id: RequestId, response: &dyn Encode);

    /// Calls a service of `Interface::clients`; the answer comes as `Event::Response`, in the order of the calls.
    fn call(&mut self, client: usize, request: &dyn Encode);

    /// Writes to `Interface::byte_streams[stream]`. Bytes to a closed stream are lost.
    fn write_bytes(&mut self, stream: usize, bytes: &[u8]);

    /// A line for the log, /rosout and the console.
    fn log(&mut self, level: Level, text: &str);

    /// Keeps `bytes` so that they outlive the process (invariant 12): the last ones come back in
    /// [`crate::NodeContext::checkpoint`] when the node starts again.
    fn checkpoint(&mut self, bytes: &[u8]);

    /// Ends the process with this exit code once the current event is handled.
    fn exit(&mut self, code: u8);
}
